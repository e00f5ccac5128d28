/** Everything that needs three.js: loaded when the first element nears the viewport. */
export { readGlb } from '../viewer/glb.js';
export { createViewer } from '../viewer/viewer.js';
