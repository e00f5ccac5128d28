import { open, ready, drawn, browser, server } from './zz-look.mjs';
import { writeFile } from 'node:fs/promises';
const n = Number(process.argv[2] ?? 1_000_000);
const values = new Float32Array(3 * n);
for (let i = 0; i < n; i++) { const z = 2 * ((i + 0.5) / n) - 1, a = i * 2.399963, r = Math.sqrt(1 - z * z); values.set([r * Math.cos(a), r * Math.sin(a), z], 3 * i); }
await writeFile('/tmp/desk-ball.ply', Buffer.concat([Buffer.from(`ply\nformat binary_little_endian 1.0\nelement vertex ${n}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`), Buffer.from(values.buffer)]));
const page = await open({}, '#count=5000');
await ready(page);
const client = await page.context().newCDPSession(page);
const events = [];
client.on('Tracing.dataCollected', ({ value }) => events.push(...value));
await client.send('Tracing.start', { transferMode: 'ReportEvents', categories: 'toplevel,devtools.timeline,disabled-by-default-devtools.timeline,disabled-by-default-v8.cpu_profiler,v8' });
await page.setInputFiles('#file', '/tmp/desk-ball.ply');
await page.waitForFunction(() => /ball/.test(document.querySelector('#caption-title').textContent), null, { timeout: 200000 });
await page.waitForTimeout(1500);
await new Promise(async (ok) => { client.once('Tracing.tracingComplete', ok); await client.send('Tracing.end'); });
const mains = events.filter((e) => e.name === 'thread_name' && e.args.name === 'CrRendererMain'); const busy = (m) => events.filter((e) => e.name === 'RunTask' && e.tid === m.tid && e.pid === m.pid).reduce((s, e) => s + (e.dur ?? 0), 0); const main = mains.sort((a, b) => busy(b) - busy(a))[0];
const tasks = events.filter((e) => e.name === 'RunTask' && e.dur > 15000 && e.tid === main?.tid && e.pid === main?.pid);
console.log('tasks over 15 ms (wall, cpu):', tasks.map((t) => [(t.dur / 1000).toFixed(0), (t.tdur / 1000).toFixed(0)].join('/')).join(' '));
const inside = (t) => events.filter((e) => e.tid === t.tid && e.pid === t.pid && e.ts >= t.ts && e.ts + (e.dur ?? 0) <= t.ts + t.dur && (e.tdur ?? 0) > 4000 && e !== t).map((e) => `${e.name} ${(e.tdur / 1000).toFixed(0)} ${e.args?.data?.functionName ?? ''} ${(e.args?.data?.url ?? '').split('/').pop()}:${e.args?.data?.lineNumber ?? ''}`);
for (const t of tasks.filter((t) => t.tdur > 15000).sort((a, b) => b.tdur - a.tdur).slice(0, 6)) console.log(`task cpu ${(t.tdur / 1000).toFixed(0)}`, inside(t));
// self time per function within the longest tasks
const profile = events.filter((e) => e.name === 'ProfileChunk');
const nodes = new Map(); const samples = []; let time = events.find((e) => e.name === 'Profile' && e.tid === main?.tid)?.args.data.startTime ?? 0;
const pid = events.find((e) => e.name === 'Profile' && e.pid === main?.pid && e.tid === main?.tid)?.id;
for (const e of profile.filter((e) => e.id === pid && e.pid === main?.pid)) { const d = e.args.data; for (const nd of d.cpuProfile?.nodes ?? []) nodes.set(nd.id, nd); (d.cpuProfile?.samples ?? []).forEach((s, i) => { time += d.timeDeltas[i]; samples.push([time, s]); }); }
for (const t of tasks.filter((t) => t.tdur > 15000).sort((a, b) => b.tdur - a.tdur).slice(0, 6)) {
  const count = new Map();
  for (const [at, s] of samples) if (at >= t.ts && at <= t.ts + t.dur) { let nd = nodes.get(s); const path = []; for (let k = 0; nd && k < 4; k++) { path.push(`${nd.callFrame.functionName}`); nd = nodes.get(nd.parent); } const key = path.join(' < '); count.set(key, (count.get(key) ?? 0) + 1); }
  console.log((t.tdur / 1000).toFixed(0), [...count].sort((a, b) => b[1] - a[1]).slice(0, 6));
}
await browser.close(); server.close();
