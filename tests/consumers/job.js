/** What Node and every page of these does with the package. */
import { createEngine } from 'pointweave';
import { load } from 'pointweave/core';

/** The same mesh by the threads build in workers, and by the other in the page's own thread, twice and directly. */
export async function job(options) {
  const scan = { model: 'duck', count: 3000, seed: 1 };
  const hashes = [];
  const reasons = [];
  for (const more of [{ threads: 2 }, { worker: false }, { worker: false }]) {
    const engine = await createEngine({ ...options, ...more });
    const mesh = await engine.reconstruct(await engine.sample(scan.model, { count: scan.count, seed: scan.seed }));
    hashes.push(await hash(mesh));
    reasons.push(mesh.report.build, mesh.report.reason);
    await engine.dispose();
  }
  const core = await load({ wasmUrl: options?.wasmUrl });
  hashes.push(await hash(core.reconstruct(await core.sample(scan.model, { count: scan.count, seed: scan.seed }))));
  return { hashes, reasons };
}

async function hash({ positions, indices }) {
  const digests = [positions, indices].map(async (array) => new Uint8Array(await crypto.subtle.digest('SHA-256', array)));
  return (await Promise.all(digests)).map((digest) => digest.slice(0, 8).join('.')).join(' ');
}
