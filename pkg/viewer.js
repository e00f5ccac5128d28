/** `pointweave/viewer`: clouds, meshes and GLBs on a canvas. It needs three.js (an optional peer of the package). */
export { createViewer } from './viewer/viewer.js';
export { readGlb } from './viewer/glb.js';
export { frameOf } from './viewer/frame.js';
export { PAINTS, PAINT_WORDS, canPaint, paintOf } from './viewer/paints.js';
export { colorAt, cssGradient } from './viewer/colormap.js';
