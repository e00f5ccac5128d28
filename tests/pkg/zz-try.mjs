import { createEngine } from '/work/wt-shop/pkg/index.node.js';
import { writeFileSync, readFileSync } from 'node:fs';
const engine = await createEngine({ threads: 1 });
const scan = await engine.sample('pig', { count: 40000 });
const time = async (n, f) => { const s = performance.now(); const r = await f(); console.log(n, ((performance.now()-s)/1000).toFixed(2)); return r; };
const full = await time('full', () => engine.reconstruct(scan));
const mesh = await time('texture', () => engine.texture(full, scan, { triangles: 5000, size: 1024, maps: ['color','normal','occlusion'] }));
for (const [k, t] of Object.entries(mesh.textures)) { console.log(k, t.width, t.height, t.data.length); writeFileSync(`/tmp/shop/t-${k}.png`, t.data); }
for (const pictures of ['png','webp','ktx2']) {
  const glb = await time(pictures, () => engine.write(mesh, { format: 'glb', quantize: true, pictures }));
  console.log(pictures, glb.length); writeFileSync(`/tmp/shop/pig-${pictures}.glb`, glb);
  const back = await engine.read(glb, { faces: 'mesh' });
  console.log(Object.entries(back.textures ?? {}).map(([k,t])=>[k,t.type,t.width]), back.uvs?.length, back.tangents?.length);
  const m = await engine.write(mesh, { format: 'glb', quantize: true, pictures, meshopt: true }); console.log('meshopt', m.length);
  if (back.textures) writeFileSync(`/tmp/shop/poster-${pictures}.png`, (await time('poster', () => engine.poster(back, { size: [640, 480], background: '#ffffff' }))).data);
}
writeFileSync('/tmp/shop/pig.usdz', await engine.write(mesh, { format: 'usdz' })); writeFileSync('/tmp/shop/pig.zip', await engine.write(mesh, { format: 'zip' }));
const h = await engine.texture(full, scan, { triangles: 5000, size: 512, scalar: 'height', maps: ['color'] });
console.log(h.textures.color.range); writeFileSync('/tmp/shop/height.png', (await engine.poster(h, { size: [640, 480], background: '#ffffff' })).data);
await engine.dispose();
