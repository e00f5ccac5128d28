// The crate on this machine and the package in wasm: one result.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { engineFor } from './support.mjs';

/** The example's program, built as the native tests build it, so that nothing is compiled twice. */
function scanToMesh() {
  const build = ['build', '--quiet', '--workspace', '--features', 'pointweave/threads', '--example', 'scan_to_mesh', '--message-format=json'];
  const lines = execFileSync('cargo', build, { cwd: new URL('../..', import.meta.url), encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });
  const made = lines.trim().split('\n').map((line) => JSON.parse(line));
  return made.find(({ target, executable }) => executable && target.name === 'scan_to_mesh').executable;
}

test('native and wasm agree to a millionth of the diagonal', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'pointweave-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const program = scanToMesh();
  const engine = await engineFor(t, { threads: 1 });
  for (const [model, count] of [['duck', 9000], ['part', 15_000]]) {
    const scan = await engine.sample(model, { count, seed: 11 });
    const [input, output] = ['scan.ply', 'mesh.ply'].map((name) => join(folder, name));
    writeFileSync(input, await engine.write(scan, { format: 'ply' }));
    execFileSync(program, [input, output], { stdio: ['ignore', 'ignore', 'inherit'] });

    const native = await engine.read(readFileSync(output), { name: 'mesh.ply', faces: 'vertices' });
    const wasm = await engine.reconstruct({ positions: Float64Array.from(scan.positions), colors: scan.colors });
    const { diagonal } = await engine.inspect(scan);
    assert.equal(native.positions.length, wasm.positions.length, `${model}: vertices`);
    assert.ok(wasm.positions.length > 9000);
    const worst = wasm.positions.reduce((most, x, i) => Math.max(most, Math.abs(x - native.positions[i])), 0);
    assert.ok(worst <= 1e-6 * diagonal, `${model}: vertices differ by ${worst / diagonal} of the diagonal`);
    assert.deepEqual(native.colors, wasm.colors, `${model}: colours`);
  }
});
