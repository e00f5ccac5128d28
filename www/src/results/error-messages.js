/**
 * What a person reads when something went wrong: what happened, in one sentence, and what to do. One entry for each
 * of the package's codes, and for those of fetching.js. The engine's own sentence, with byte or line, is shown below.
 *
 * @typedef {{ title: string, text: string, advice: string }} Message
 */

const READABLE = 'It is none of the kinds of scan that Pointweave reads: PLY, LAS, LAZ, E57, PTX, PCD, OBJ, OFF, STL, GLB, 3MF, elevation grids (ESRI ASCII, GeoTIFF), Gaussian splats (PLY, SPLAT, SPZ), or text with x y z on each line; alone, or in a ZIP or gzip file.';
const CONVERT = 'Convert the file to PLY in the program that made it.';
const DEFECT = 'Try again. If it happens once more, please report the line below.';

/** @type {Record<string, Message>} */
export const MESSAGES = {
  'empty-cloud': {
    title: 'There are no points in this file',
    text: 'The file can be read, but it holds no points.',
    advice: 'Export the scan again, as a point cloud.',
  },
  'too-few-points': {
    title: 'Too few points for a surface',
    text: 'A surface needs more points than there are.',
    advice: 'Keep a larger share, or take a denser scan.',
  },
  'bad-length': {
    title: 'The parts of this scan do not fit together',
    text: 'It has not as many colours, normals or values as it has points.',
    advice: 'Export the scan again.',
  },
  'non-finite': {
    title: 'A point is nowhere',
    text: 'One of the values is not a finite number, so the point has no place.',
    advice: 'Remove invalid points in the program that made the scan, and export it again.',
  },
  'bad-input': {
    title: 'This cannot be worked on',
    text: 'Something was handed over that is no scan.',
    advice: DEFECT,
  },
  detached: {
    title: 'This scan was handed on already',
    text: 'Its points are no longer here: another part of the program took them.',
    advice: 'Open the file again.',
  },
  'bad-option': {
    title: 'One of the settings is not possible',
    text: 'A value is out of the range that the engine takes.',
    advice: 'Change it under “More settings”, or reset them.',
  },
  degenerate: {
    title: 'These points span no surface',
    text: 'They all lie on one line or at one place. The reduced points are shown.',
    advice: 'Try another scan.',
  },
  'unknown-format': { title: 'This is not a scan that can be read', text: READABLE, advice: CONVERT },
  'bad-file': {
    title: 'This file breaks the rules of its format',
    text: 'Something else was found at the place below than belongs there, so nothing of the file was used.',
    advice: 'Mend that place if the file is text, or export it again. If it was downloaded, check that all of it arrived.',
  },
  'unsupported-file': { title: 'This kind of file is not supported yet', text: READABLE, advice: CONVERT },
  'load-failed': {
    title: 'The engine could not be loaded',
    text: 'Pointweave computes with a WebAssembly program that belongs to this page, and it did not arrive.',
    advice: 'Check the connection and reload the page.',
  },
  'out-of-memory': {
    title: 'Not enough memory for this scan',
    text: 'The browser gives a page a limited amount of memory, and this scan needs more.',
    advice: 'Keep fewer points, close other tabs, or try a computer with more memory.',
  },
  disposed: {
    title: 'The engine was stopped',
    text: 'The page is closing or starting anew.',
    advice: 'Reload the page.',
  },
  internal: {
    title: 'Something went wrong',
    text: 'That should not have happened, and your scan was not changed.',
    advice: DEFECT,
  },
  'bad-index': {
    title: 'The triangles of this mesh do not fit its points',
    text: 'One of them has a corner that does not exist.',
    advice: 'Export the file again.',
  },
  'needs-triangles': {
    title: 'This format is for meshes alone',
    text: 'Points without triangles cannot be saved in it.',
    advice: 'Choose another format.',
  },
  'no-webgl': {
    title: 'The picture cannot be drawn',
    text: 'This browser offers no WebGL 2, which the picture needs.',
    advice: 'Turn on hardware acceleration in the settings, or use another browser.',
  },
  'missing-package': {
    title: 'A part of the program is missing',
    text: 'The page was built without something that this needs.',
    advice: DEFECT,
  },
  'empty-folder': {
    title: 'There are no files in this folder',
    text: 'A folder was dropped, and nothing in it is a file that can be seen.',
    advice: 'Drop the scan itself.',
  },
  'bad-step': {
    title: 'A step of the tidying cannot be done',
    text: 'It does not fit this scan, or nothing would be left. It is switched off.',
    advice: 'Remove it, or do it anew.',
  },
  'kept-no-more': {
    title: 'This scan is not kept any more',
    text: 'A browser keeps the last few scans on this device, and this one made room or was forgotten.',
    advice: 'Open the file again.',
  },
  'not-found': {
    title: 'The scan could not be fetched',
    text: 'The address of this page asks for a file that did not arrive.',
    advice: 'Check the address and the connection, or open the file from this device.',
  },
  'other-server': {
    title: 'The scan lies on another server',
    text: 'This page talks to nobody but the server that it came from, so that nothing about you gets anywhere.',
    advice: 'Download the file and drop it here.',
  },
  'bad-address': {
    title: 'The scan has no proper address',
    text: 'What follows ?src= in the address of this page does not name a file.',
    advice: 'Check the address, or open the file from this device.',
  },
};
