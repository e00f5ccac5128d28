// Never run: `tsc` checks that the viewer's types say what its documentation does, and that its functions agree.

import * as declared from 'pointweave/viewer';
import { canPaint, createViewer, frameOf, paintOf, readGlb, type Axis, type Paint, type StreamState, type Viewer } from 'pointweave/viewer';
import type { PointCloud, SurfaceMesh } from 'pointweave';
import type * as written from '../../pkg/viewer/viewer.js';
import type * as paints from '../../pkg/viewer/paints.js';
import type * as glb from '../../pkg/viewer/glb.js';

/** The functions have what is declared. */
export function conform(made: typeof written.createViewer, paint: typeof paints, read: typeof glb.readGlb) {
  const { createViewer, paintOf, canPaint, PAINTS, PAINT_WORDS }: Partial<typeof declared> = { createViewer: made, ...paint };
  return [createViewer, paintOf, canPaint, PAINTS, PAINT_WORDS, read satisfies (bytes: Uint8Array<ArrayBuffer>) => Promise<declared.Model>];
}

export async function use(canvas: HTMLCanvasElement, cloud: PointCloud, mesh: SurfaceMesh) {
  const viewer: Viewer = createViewer(canvas, { up: 'z', colors: { mesh: 'oklch(0.8 0.1 60)' }, insets: { bottom: 40 } });
  viewer.show(mesh);
  viewer.show(await readGlb(new Uint8Array(8)));
  viewer.show(cloud, { frame: frameOf(cloud) });
  viewer.set('reduced', { ...mesh.cloud, oriented: true });
  viewer.set('mesh', mesh);
  viewer.view = { left: 'points', right: 'mesh', at: 0.5 };
  const paint: Paint = paintOf('error', 'mesh', { cloud, mesh, reduced: mesh.cloud });
  if (paint.legend && 'kinds' in paint.legend) paint.legend.kinds.map(([color, name]) => `${color} ${name}`);
  viewer.paint('mesh', paint);
  viewer.colors = { edges: 'black' };
  viewer.up = viewer.upright satisfies Axis;
  viewer.addEventListener('move', ({ detail: { by } }) => console.log(by satisfies 'pointer' | 'keys' | 'program'));
  await viewer.stream('tileset.json', { budget: 1e8, errorTarget: 4, signal: AbortSignal.timeout(1000), onProgress: (share) => share.toFixed() });
  viewer.addEventListener('stream', () => console.log((viewer.streamed satisfies StreamState | null)?.total?.toFixed()));
  // @ts-expect-error no such option
  viewer.stream('tileset.json', { memory: 1e8 });
  viewer.addEventListener('contextlost', () => viewer.suspend());
  // @ts-expect-error no such paint
  canPaint('heat', { cloud });
  // @ts-expect-error a side has no corner
  viewer.lookFrom('corner');
  return viewer.toBlob('image/webp', 0.8);
}
