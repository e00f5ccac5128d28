// `cargo xtask bench formats`: each format from Pointweave's writers to the readers of others, and from their writers to
// Pointweave's readers. Positions, bounds, colours, normals, attributes, triangles, up and unit have to be equal; it fails where one is
// not. PEERS_PYTHON is a Python with what tests/bench/formats.txt lists.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const HERE = dirname(fileURLToPath(import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'pointweave-formats-'));

function run(program, ...args) {
  const { status, error } = spawnSync(program, args, { stdio: ['ignore', 'ignore', 'inherit'] });
  if (status !== 0) throw error ?? new Error(`${program} ${args[0]} ended with ${status}`);
}

try {
  run(process.execPath, join(HERE, 'ours.mjs'), 'write', folder);
  run(process.env.PEERS_PYTHON ?? 'python3', join(HERE, 'peers.py'), folder);
  run(process.execPath, join(HERE, 'ours.mjs'), 'read', folder);
  const rows = (name) => JSON.parse(readFileSync(join(folder, name), 'utf8'));
  const tables = {
    'Written by Pointweave, read by': [...rows('validated.json'), ...rows('theirs-read.json')],
    'Read by Pointweave, written by': rows('read.json'),
  };
  for (const [title, table] of Object.entries(tables)) {
    console.log(`\n${title}`);
    for (const [file, by, result] of table) console.log(`  ${file.padEnd(24)} ${by.padEnd(16)} ${result}`);
    if (table.some(([, , result]) => result !== 'equal')) process.exitCode = 1;
  }
} finally {
  rmSync(folder, { recursive: true });
}
