// The command line, as a program of its own.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { linkSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { buffer } from 'node:stream/consumers';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { validateBytes } from 'gltf-validator';
import { inspect, read, reconstruct, reduce, sample, write } from 'pointweave';
import { parse } from '../../pkg/cli/arguments.js';
import { openInput, writeOutput } from '../../pkg/files/disk.js';
import { WORDS } from '../../pkg/cli/flags.js';
import { UsageError } from '../../pkg/cli/usage.js';
import { TARGETS } from '../../pkg/engine/options-table.js';
import { TABLES } from '../../pkg/engine/options.js';
import { openPage } from './browser.mjs';
import { rejection } from './support.mjs';

const CLI = fileURLToPath(new URL('../../pkg/cli.js', import.meta.url));
/** Makes a program think that a person looks at its messages. */
const TERMINAL = ['--import', 'data:text/javascript,process.stderr.isTTY=true;process.stderr.columns=70'];

const scan = await sample('duck', { count: 1500, seed: 5 });
const scanFile = await write(scan, { format: 'ply' });
const cloud = await read(scanFile);

/** A folder with scan.ply in it. */
function folder(t) {
  const path = mkdtempSync(join(tmpdir(), 'pointweave-cli-'));
  t.after(() => rmSync(path, { recursive: true }));
  writeFileSync(join(path, 'scan.ply'), scanFile);
  return path;
}

/** Starts the program; `ended` is its exit code and what it has said. */
function start(cwd, args, node = []) {
  const child = spawn(process.execPath, [...node, CLI, ...args], { cwd });
  const exit = new Promise((resolve) => child.once('close', (code, signal) => resolve(code ?? signal)));
  const ended = Promise.all([exit, buffer(child.stdout), buffer(child.stderr)]).then(([code, stdout, stderr]) => ({ code, stdout, stderr: String(stderr) }));
  return { child, ended };
}

async function run(cwd, args, input) {
  const { child, ended } = start(cwd, args);
  child.stdin.on('error', () => {}); // it may not want to read
  child.stdin.end(input);
  return ended;
}

/** Runs what has to succeed. */
async function good(cwd, args, input) {
  const { code, stdout, stderr } = await run(cwd, args, input);
  assert.equal(code, 0, stderr);
  return { stdout, stderr };
}

test('a file of every format, to the bytes of the package', async (t) => {
  const path = folder(t);
  const [light, mesh] = [await reduce(cloud, { target: { count: 700 } }), await reconstruct(cloud)];
  for (const format of ['ply', 'xyz', 'glb', 'obj', 'stl']) {
    const { stdout, stderr } = await good(path, ['reconstruct', 'scan.ply', '-o', `mesh.${format}`]);
    assert.deepEqual(readFileSync(join(path, `mesh.${format}`)), Buffer.from(await write(mesh, { format })), format);
    assert.equal(stdout.length, 0);
    assert.match(stderr, /^pointweave: scan\.ply → mesh\.\w+: 1,500 → 500 points → [\d,]+ triangles, .*\n$/);
    if (format === 'stl') continue;
    await good(path, ['reduce', 'scan.ply', '--out', `light.${format.toUpperCase()}`, '--count', '700', '--threads', '1']);
    assert.deepEqual(readFileSync(join(path, `light.${format.toUpperCase()}`)), Buffer.from(await write(light, { format })), format);
  }
  assert.deepEqual(readdirSync(path).filter((name) => name.startsWith('.')), [], 'nothing half done is left');
});

test("a GLB file that the validator has nothing to say about, and the browser's bytes", async (t) => {
  const path = folder(t);
  await good(path, ['reconstruct', 'scan.ply', '-o', 'mesh.glb', '--threads', '2']);
  const bytes = readFileSync(join(path, 'mesh.glb'));
  assert.deepEqual((await validateBytes(new Uint8Array(bytes))).issues.messages, []);

  const page = await openPage(t);
  const hash = await page.evaluate(async (numbers) => {
    const { read, reconstruct, write } = await import('pointweave');
    const mesh = await reconstruct(await read(Uint8Array.from(numbers)));
    const digest = await crypto.subtle.digest('SHA-256', await write(mesh, { format: 'glb' }));
    return [...new Uint8Array(digest)].map((x) => x.toString(16).padStart(2, '0')).join('');
  }, [...scanFile]);
  assert.equal(createHash('sha256').update(bytes).digest('hex'), hash);
});

test('--json prints the report and nothing else', async (t) => {
  const path = folder(t);
  const { stdout, stderr } = await good(path, ['reconstruct', 'scan.ply', '-o', 'mesh.ply', '--json', '--no-reduce']);
  const report = JSON.parse(stdout);
  const { report: expected } = await reconstruct(cloud, { reduce: false });
  assert.deepEqual(Object.keys(report), Object.keys(expected));
  assert.deepEqual([report.triangles, report.outputPoints, report.distance], [expected.triangles, 1500, expected.distance]);
  assert.equal(stderr, '');
  assert.ok(statSync(join(path, 'mesh.ply')).size > 10_000);

  const alone = await good(path, ['reduce', 'scan.ply', '--json', '--ratio', '0.1']);
  assert.equal(JSON.parse(alone.stdout).outputPoints, 150);
  const info = await good(path, ['inspect', 'scan.ply', '--json']);
  assert.deepEqual(JSON.parse(info.stdout), { ...(await inspect(cloud)), skipped: cloud.skipped, file: cloud.file });
});

test('inspect tells it in words', async (t) => {
  const far = await good(folder(t), ['inspect', '-'], '4512345.125 -543210.5 100\n4512346.125 -543211.5 101.0009766\n');
  assert.match(String(far.stdout), /lowest corner +4512345\.125 -543211\.5 100\n.*highest corner +4512346\.125 -543210\.5 101\.000977\n/);
  const { stdout } = await good(folder(t), ['inspect', 'scan.ply']);
  for (const said of [/^scan\.ply\n/, /points +1,500\n/, /left out +none\n/, /also has +colours\n/, /spacing +0\.\d+\n/]) assert.match(String(stdout), said);
});

test('what of a file is no point is told', async (t) => {
  const path = folder(t);
  const header = (count) => `ply\nformat ascii 1.0\nelement vertex ${count}\nproperty float x\nproperty float y\nproperty float z\nproperty float value\n`;
  writeFileSync(join(path, 'some.ply'), `${header(5)}element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 nan\n0 1 0 1\nnan 0 0 1\n0 0 1 1\n3 0 1 2\n`);
  writeFileSync(join(path, 'none.ply'), `${header(2)}end_header\n0 inf 0 1\nnan 0 0 1\n`);
  const { stdout } = await good(path, ['inspect', 'some.ply', '--faces', 'vertices']);
  for (const said of [/points +4\n/, /left out +1 not finite\n/, /of that +1 not finite, taken for 0\n/, /faces +1, not read\n/]) assert.match(String(stdout), said);
  const { stderr } = await good(path, ['reduce', 'some.ply', '-o', 'one.ply', '--count', '1', '--faces', 'vertices']);
  assert.match(stderr, /4 → 1 point, .* s; left out: 1 not finite\n$/);
  const none = await run(path, ['reconstruct', 'none.ply', '-o', 'mesh.ply']);
  assert.deepEqual([none.code, none.stderr], [1, 'pointweave: none.ply: the file has 2 points, none of them finite\n']);
});

test('a file is read from the disk slice by slice, whatever its size; a pipe is taken whole', async (t) => {
  const path = folder(t);
  const { signal } = new AbortController();
  assert.ok((await openInput(join(path, 'scan.ply'), signal)) instanceof Blob);
  assert.equal((await openInput('/dev/null', signal)).length, 0);
  const error = await rejection(openInput(join(path, 'none.ply'), signal));
  assert.equal(error.code, 'ENOENT');
});

test('standard input and standard output', async (t) => {
  const path = folder(t);
  const mesh = await good(path, ['reconstruct', '-', '-o', '-', '--format', 'glb', '--quantize'], scanFile);
  assert.deepEqual(mesh.stdout, Buffer.from(await write(await reconstruct(cloud), { format: 'glb', quantize: true })));
  assert.match(mesh.stderr, /^pointweave: standard input → standard output: /);
  const light = await good(path, ['reduce', 'scan.ply', '-o', '-', '--encoding', 'ascii']);
  assert.match(String(light.stdout), /^ply\nformat ascii 1\.0\n/);
});

test('many files: one that is bad does not stop the others', async (t) => {
  const path = folder(t);
  writeFileSync(join(path, 'broken.ply'), scanFile.subarray(0, 3000));
  writeFileSync(join(path, 'last.xyz'), await write(scan, { format: 'xyz' }));
  const files = ['scan.ply', 'broken.ply', 'nowhere.ply', 'last.xyz'];
  const { code, stdout, stderr } = await run(path, ['reduce', ...files, '--out-dir', 'out/light', '--format', 'glb', '--json']);
  assert.equal(code, 1);
  const lines = stderr.trimEnd().split('\n');
  assert.equal(lines.length, 3);
  assert.match(lines[0], /^pointweave: broken\.ply: bad PLY file at byte \d+/);
  assert.match(lines[1], /^pointweave: nowhere\.ply: there is no such file/);
  assert.equal(lines[2], 'pointweave: 2 of 4 files done, 2 failed');
  const entries = JSON.parse(stdout);
  assert.deepEqual(entries.map(({ input }) => input), files);
  assert.deepEqual(entries.map(({ error, report }) => error?.code ?? report.outputPoints), [500, 'bad-file', 'ENOENT', 500]);
  assert.deepEqual(readdirSync(join(path, 'out/light')).sort(), ['last.glb', 'scan.glb']);
  assert.equal(entries[3].output, join('out/light', 'last.glb'));

  const all = await good(path, ['reconstruct', 'scan.ply', 'last.xyz', '--out-dir', 'out']);
  assert.match(all.stderr, /2 of 2 files done\n$/);
  assert.deepEqual(readdirSync(join(path, 'out')).sort(), ['last.ply', 'light', 'scan.ply']);
});

test('what fails has exit code 1 and one line', async (t) => {
  const path = folder(t);
  writeFileSync(join(path, 'note.txt'), 'these are no points\nat all\n');
  writeFileSync(join(path, 'three.xyz'), '0 0 0\n1 0 0\n0 1 0\n');
  const cases = [
    [['inspect', 'nowhere.ply'], /nowhere\.ply: there is no such file/],
    [['inspect', '.'], /\.: it is a folder/],
    [['inspect', 'note.txt'], /note\.txt: .+/],
    [['reconstruct', 'three.xyz', '-o', 'mesh.ply'], /three\.xyz: too few points: 3 found, at least 4 needed/],
    [['reduce', 'scan.ply', '-o', 'missing/light.ply'], /scan\.ply: 'missing\/light\.ply' cannot be written: there is no such file or folder/],
    [['reduce', 'scan.ply', '--out-dir', 'scan.ply'], /'scan\.ply' cannot be made: a file has that name/],
    [['reduce', 'scan.ply', '-o', 'light.ply', '--attributes', 'nothing=majority'], /option attributes/],
    [['inspect', 'nowhere.ply', '--json'], /there is no such file/],
    [['reduce', 'nowhere.ply', '-o', 'light.glb', '--meshopt'], /meshopt needs packages/], // before the work
  ];
  for (const [args, line] of cases) {
    const { code, stdout, stderr } = await run(path, args);
    assert.equal(code, 1, `${args}: ${stderr}`);
    assert.match(stderr, line);
    assert.match(stderr, /^pointweave: [^\n]+\n$/, 'one line');
    assert.equal(stdout.length, 0);
  }
  assert.deepEqual(readdirSync(path).sort(), ['note.txt', 'scan.ply', 'three.xyz']);
});

test('what cannot be meant has exit code 2, before anything is read or written', async (t) => {
  const path = folder(t);
  const cases = [
    [[], /a command is needed/],
    [['recuce', 'scan.ply'], /no command 'recuce': did you mean reduce\?/],
    [['reduce'], /reduce needs a file/],
    [['scan.ply', '-o', 'mesh.glb'], /'scan\.ply' looks like a file, .*: did you mean pointweave reconstruct scan\.ply -o mesh\.glb\?$/],
    [['--ratio', '0.2', 'scan.ply'], /a command comes before --ratio: reduce, reconstruct, inspect, prepare, merge, simplify, poster, catalogue or tiles$/],
    [['reduce', 'scan.ply'], /where should the result go\?/],
    [['reduce', 'scan.ply', '-o', 'light.step'], /'light\.step' is no format that is written: expected ply, xyz, glb, obj, pcd, las, laz, usdz, zip$/],
    [['reconstruct', 'scan.ply', '-o', 'mesh'], /'mesh' has no extension to say the format: expected ply, xyz, glb, obj, stl, pcd, las, laz, 3mf, usdz, zip$/],
    [['reduce', 'scan.ply', '-o'], /--out needs a value$/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--seed', '-1'], /--seed needs a value; one that begins with - is given as --seed=-…$/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--seed=-1'], /--seed is '-1': expected an integer/],
    [['reduce', 'scan.ply', '--json=yes'], /--json takes no value$/],
    [['reduce', 'scan.ply', '-o', 'light.stl'], /STL and 3MF files hold triangles, not points/],
    [['reduce', 'scan.ply', '-o', 'light.3mf'], /STL and 3MF files hold triangles, not points/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--ration', '0.5'], /no option 'ration': did you mean --ratio\?/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--accuracy', '0.5'], /no option 'accuracy', which is for reconstruct and catalogue$/],
    [['inspect', 'scan.ply', '--ratio', '0.5'], /no option 'ratio', which is for reduce, reconstruct, catalogue and tiles$/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--ratio', '20%'], /--ratio is '20%': expected a number in \(0, 1\]: did you mean 0\.2\?$/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--ratio', '1/3'], /did you mean 0\.3333\?$/],
    [['reconstruct', 'scan.ply', '-o', 'a.ply', '--accuracy', '0.1 %'], /did you mean 0\.001\?$/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--ratio', '120%'], /expected a number in \(0, 1\]$/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--ratio', '1.5'], /--ratio is '1\.5': expected a number in \(0, 1\]/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--count', ''], /--count is '': expected 'auto' or an integer/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--ratio', '0.5', '--count', '9'], /--ratio and --count exclude each other/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--method', 'best'], /--method is 'best': expected one of 'adaptive', 'paper'/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--attributes', 'label'], /expected NAME=HOW/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--attributes', 'label=median'], /attributes\.label is 'median'/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--threads', '0'], /--threads is '0': expected 'auto' or an integer from 1 to 64/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--quantize'], /--quantize is for GLB files/],
    [['reduce', 'scan.ply', '-o', 'a.glb', '--encoding', 'ascii'], /--encoding is for PLY files/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--format', 'glb'], /has its extension/],
    [['reduce', 'scan.ply', '-o', 'a.ply', '--out-dir', 'b'], /exclude each other/],
    [['reduce', 'scan.ply', '-o', '-', '--json'], /both want standard output/],
    [['reduce', 'scan.ply', 'scan.ply', '-o', 'a.ply'], /--out takes one file, and there are 2/],
    [['reduce', 'scan.ply', 'a/scan.xyz', '--out-dir', 'b'], /'scan\.ply' and 'a\/scan\.xyz' would both become 'b\/scan\.ply'/],
    [['reduce', '-', '--out-dir', 'b'], /standard input has no name/],
    [['inspect', '-', '-'], /standard input can be read once/],
    [['inspect', 'scan.ply', '-o', 'a.ply'], /inspect has no option 'o', which is for reduce, reconstruct, prepare, merge, simplify, poster, catalogue and tiles$/],
    [['poster', 'scan.ply', '-o', 'a.jpg'], /'a\.jpg' is no format of posters: expected png$/],
    [['poster', 'scan.ply', '-o', 'a.png', '--size', '800'], /--size is '800': expected WIDTHxHEIGHT, each 16 to 4096$/],
    [['catalogue', 'scans'], /where should the site go\? -o FOLDER$/],
    [['reconstruct', 'scan.ply', '-o', 'a.ply', '--no-reduce', '--ratio', '0.5'], /--no-reduce leaves nothing/],
    [['reconstruct', 'scan.ply', '-o', 'a.ply', '--sharp', '--no-sharp'], /exclude each other/],
  ];
  await Promise.all(cases.slice(0, 3).map(([args, line]) => usage(path, args, line)));
  for (const [args, line] of cases) {
    assert.throws(() => parse(args), (error) => error instanceof UsageError && line.test(error.message), String(args));
  }
  assert.deepEqual(readdirSync(path), ['scan.ply']);
});

async function usage(path, args, line) {
  const { code, stdout, stderr } = await run(path, args);
  assert.equal(code, 2, stderr);
  assert.match(stderr, line);
  assert.match(stderr, /See pointweave .*--help\n$/);
  assert.equal(stdout.length, 0);
}

test('a result never takes the place of a scan', async (t) => {
  const path = folder(t);
  mkdirSync(join(path, 'sub'));
  symlinkSync('scan.ply', join(path, 'link.ply'));
  linkSync(join(path, 'scan.ply'), join(path, 'other.ply'));
  for (const out of [['-o', 'scan.ply'], ['-o', './sub/../scan.ply'], ['-o', 'link.ply'], ['-o', 'other.ply'], ['--out-dir', '.']]) {
    await usage(path, ['reduce', 'scan.ply', ...out], /is the scan itself/);
  }
  assert.deepEqual(readFileSync(join(path, 'scan.ply')), Buffer.from(scanFile));
});

test('an earlier result is replaced, through a link; a device is written to', async (t) => {
  const path = folder(t);
  writeFileSync(join(path, 'old.xyz'), 'old');
  symlinkSync('old.xyz', join(path, 'link.xyz'));
  symlinkSync('/dev/null', join(path, 'null.xyz'));
  for (const name of ['link.xyz', 'null.xyz']) await good(path, ['reduce', 'scan.ply', '-o', name, '--count', '9']);
  assert.match(readFileSync(join(path, 'old.xyz'), 'utf8'), /^(.+\n){9}$/);
  assert.ok(statSync(join(path, 'null.xyz')).isCharacterDevice());
  assert.deepEqual(readdirSync(path).sort(), ['link.xyz', 'null.xyz', 'old.xyz', 'scan.ply']);
});

test('a result that is not written to its end leaves what was there', async (t) => {
  const path = folder(t);
  const interrupted = new AbortController();
  const bytes = new Uint8Array(1 << 27);
  const writing = rejection(writeOutput(join(path, 'scan.ply'), bytes, interrupted.signal));
  for (let tries = 0; readdirSync(path).length < 2 && tries < 5000; tries++) await new Promise((resolve) => setTimeout(resolve));
  assert.match(readdirSync(path).join(), /^\.pointweave-.*\.part,scan\.ply$/, 'it is being written');
  interrupted.abort();
  assert.equal((await writing).code, 'ABORT_ERR');
  assert.deepEqual(readdirSync(path), ['scan.ply']);
  assert.deepEqual(readFileSync(join(path, 'scan.ply')), Buffer.from(scanFile));
});

test('Ctrl-C ends the work and leaves no file', async (t) => {
  const path = folder(t);
  writeFileSync(join(path, 'large.ply'), await write(await sample('pig'), { format: 'ply' }));
  for (const [signal, expected, threads] of [['SIGINT', 130, '1'], ['SIGTERM', 143, '2']]) {
    const { child, ended } = start(path, ['reconstruct', 'large.ply', '-o', 'mesh.glb', '--threads', threads], TERMINAL);
    await new Promise((shown) => child.stderr.on('data', (data) => String(data).includes('features') && shown()));
    child.kill(signal);
    const { code, stderr } = await ended;
    assert.equal(code, expected, stderr);
    assert.match(stderr, /interrupted: nothing unfinished was left behind\n$/);
  }
  const waiting = start(path, ['reduce', '-', '-o', 'light.ply'], TERMINAL);
  waiting.child.stdin.write(scanFile.subarray(0, 1000));
  await new Promise((resolve) => setTimeout(resolve, 1000));
  waiting.child.kill('SIGINT');
  assert.equal((await waiting.ended).code, 130);
  assert.deepEqual(readdirSync(path).sort(), ['large.ply', 'scan.ply']);
});

test('progress is a bar on a terminal and nothing elsewhere', async (t) => {
  const path = folder(t);
  const { child, ended } = start(path, ['reconstruct', 'scan.ply', '-o', 'mesh.glb'], TERMINAL);
  child.stdin.end();
  const { code, stderr } = await ended;
  assert.equal(code, 0, stderr);
  const frames = stderr.split('\r').filter((frame) => frame.includes(' %  '));
  assert.ok(frames.length > 1, stderr);
  assert.match(frames[0], / 0 %  read /);
  for (const frame of frames) assert.match(frame, /^█*░* +\d+ %  [a-z]+ +scan\.ply\x1b\[K$/);
  assert.match(stderr, /\r\x1b\[Kpointweave: scan\.ply → mesh\.glb: .*\n$/, 'it goes when the work is done');
  assert.doesNotMatch((await good(path, ['reconstruct', 'scan.ply', '-o', 'mesh.glb'])).stderr, /[█░\r]/);
});

test('every option of the package is a flag, with a word in the help', async (t) => {
  const path = folder(t);
  const [light, surface] = await Promise.all(['reduce', 'reconstruct'].map(async (command) => String((await good(path, [command, '--help'])).stdout)));
  const kebab = (key) => key.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
  // Those are of another shape, and no file holds what the others give.
  const { target, assignment, cells, ...reduction } = TABLES.reduce;
  const { distances, keep, ...fitting } = TABLES.reconstruct;
  const { name, format: from, beside, ...reading } = TABLES.read;
  const { columns, delimiter, decimal, skip, sentinels, ...worded } = reading; // whose words stand beside their flags
  const { format, up, unit, ...writing } = TABLES.write;
  for (const key of Object.keys({ ...TARGETS, ...reduction, ...reading, ...writing, toUp: up, toUnit: unit })) {
    for (const help of [light, surface]) assert.match(help, new RegExp(`\\n  --(no-)?${kebab(key)}\\b`), key);
  }
  for (const key of Object.keys(fitting)) assert.match(surface, new RegExp(`\\n  --(no-)?${kebab(key)}\\b`), key);
  const simpler = String((await good(path, ['simplify', '--help'])).stdout);
  for (const key of Object.keys(TABLES.simplify)) assert.match(simpler, new RegExp(`\\n  --${key}\\b`), key);
  for (const flag of ['texture', 'maps', 'scalar', 'range', 'lods']) assert.match(surface, new RegExp(`\\n  --${flag}\\b`), flag);
  const drawn = String((await good(path, ['poster', '--help'])).stdout);
  for (const key of Object.keys(TABLES.poster)) assert.match(drawn, new RegExp(`\\n  --${key}\\b`), key);
  const made = { ...TABLES.simplify, ...TABLES.poster, texture: {}, maps: {}, scalar: {}, range: {}, lods: {} };
  assert.deepEqual(Object.keys(WORDS).sort(), Object.keys({ ...TARGETS, ...reduction, ...fitting, ...made, ...worded, ...writing, up, unit }).sort());

  const line = 'reconstruct a.ply -o b.glb --flatness 0.001 --method paper --max-iterations 7 --norm diagonal --curvature-weight 0 ' +
    '--attributes label=majority --attributes a=b=nearest --outliers drop --accuracy 1e-3 --smoothing auto --resolution 0.02 --no-orient --sharp ' +
    '--boundary closed --quantize --threads auto';
  const parsed = parse(line.split(' '));
  assert.deepEqual(parsed.own, {
    reduce: {
      target: { flatness: 0.001 }, method: 'paper', maxIterations: 7, norm: 'diagonal', curvatureWeight: 0,
      attributes: { label: 'majority', 'a=b': 'nearest' }, outliers: 'drop',
    },
    accuracy: 1e-3, smoothing: 'auto', resolution: 0.02, orient: false, sharp: true, boundary: 'closed',
  });
  assert.deepEqual([parsed.write, parsed.format, parsed.threads], [{ quantize: true }, 'glb', 'auto']);
  assert.deepEqual(parse(['reduce', 'a.ply', '--json', '--seed=3', '--threads', '2']).own, { seed: 3 });
});

test('--version and --help', async (t) => {
  const path = folder(t);
  const { version } = JSON.parse(readFileSync(new URL('../../pkg/package.json', import.meta.url), 'utf8'));
  assert.equal(String((await good(path, ['--version'])).stdout), `${version}\n`);
  assert.match(String((await good(path, ['--help'])).stdout), /reduce .*\n.*reconstruct .*\n.*inspect /);
  assert.match(String((await good(path, ['inspect', '-h'])).stdout), /--json/);
  assert.deepEqual([parse(['help']), parse(['help', 'reduce'])], [{ help: undefined }, { help: 'reduce' }]);
});
