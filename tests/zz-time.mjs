import { sample, createEngine } from 'pointweave';
const n = Number(process.argv[2] ?? 1_000_000);
const engine = await createEngine({ threads: 2 });
const cloud = await engine.sample('table', { count: n, seed: 1 }).catch(async () => engine.sample('duck', { count: n, seed: 1 }));
console.log(cloud.positions.length / 3);
for (const steps of [[{ step: 'outliers' }], [{ step: 'flying' }], [{ step: 'plane', drop: 'floor' }], [{ step: 'pieces' }], [{ step: 'outliers' }, { step: 'flying' }, { step: 'plane', drop: 'floor' }, { step: 'pieces' }], [{ step: 'box', min: [-1, -1, -1], max: [1e6, 1e6, 1e6] }]]) {
  const t = performance.now();
  const r = await engine.prepare(cloud, steps).catch((e) => ({ steps: [{ step: String(e) }] }));
  console.log((performance.now() - t).toFixed(0), r.steps.map((s) => `${s.step} ${s.ms?.toFixed(0)}`).join(', '));
}
const t = performance.now();
const r = await engine.reduce(cloud);
console.log('reduce', (performance.now() - t).toFixed(0), JSON.stringify(r.report.ms));
await engine.dispose();
