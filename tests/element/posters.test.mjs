// Posters, drawn without a browser, beside what the element shows of the same in one.

import assert from 'node:assert/strict';
import { poster, read, reconstruct, write } from 'pointweave';
import { decodePng } from '../page/pictures.mjs';
import { duckScan } from './files.mjs';
import { startSite, test } from './site.mjs';

const site = await startSite();
const scan = await duckScan({ count: 20_000 });
const cloud = await read(scan.bytes);
const mesh = await reconstruct(cloud, { triangles: 3000, texture: { size: 512 } });
site.put('/duck.ply', scan.bytes);
site.put('/duck.glb', Buffer.from(await write(mesh, { format: 'glb' })));

const STYLE = 'h1 { display: none } point-weave { width: 480px; height: 360px; --point-weave-background: #808080 }';

/** Mean difference of two pictures where one of them shows something, in grey levels, and share of the picture that only one covers. */
function apart(one, other, background) {
  let [sum, count, odd] = [0, 0, 0];
  for (let i = 0; i < one.width * one.height; i++) {
    const [first, second] = [one, other].map(({ data, channels }) => [...data.subarray(channels * i, channels * i + 3)]);
    const is = [first, second].map((color) => color.some((value) => Math.abs(value - background) > 2));
    if (!is.some(Boolean)) continue;
    count++;
    if (is[0] !== is[1]) odd++;
    for (let c = 0; c < 3; c++) sum += Math.abs(first[c] - second[c]) / 3;
  }
  return { mean: sum / count, odd: odd / count, count };
}

for (const [what, src, attributes, camera, most] of [
  [mesh, '/duck.glb', '', undefined, 3],
  [mesh, '/duck.glb', 'camera-orbit="200deg 60deg 80%"', '200deg 60deg 80%', 3],
  [cloud, '/duck.ply', 'view="points"', undefined, 6],
]) {
  test(`the poster of ${src} ${camera ?? ''} is what the element shows`, async (t) => {
    const shown = await site.open(`<point-weave src="${src}" alt="A duck" ${attributes}></point-weave>`, { style: STYLE });
    await shown.loaded();
    const there = decodePng(await shown.picture());
    const { data, width, height, type } = await poster(what, { size: [480, 360], background: '#808080', camera });
    assert.deepEqual([width, height, type], [480, 360, 'image/png']);
    const here = decodePng(Buffer.from(data));
    assert.deepEqual([here.width, here.height], [there.width, there.height]);
    const { mean, odd, count } = apart(here, there, 0x80);
    t.diagnostic(`${mean.toFixed(2)} grey levels, ${(100 * odd).toFixed(2)} % of ${count} pixels in one alone`);
    assert.ok(mean < most && odd < 0.03, `${mean} ${odd}`);
  });
}
