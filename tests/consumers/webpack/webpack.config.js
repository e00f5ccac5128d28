import { fileURLToPath } from 'node:url';

const folder = fileURLToPath(new URL('.', import.meta.url));

export default {
  mode: 'production',
  context: folder,
  entry: './main.js',
  output: { path: `${folder}dist`, filename: 'main.js', clean: true },
  performance: { hints: false },
};
