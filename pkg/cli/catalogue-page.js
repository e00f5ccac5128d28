/** The pages of a catalogue: all models with the element, and a sheet on which one look finds the one that failed. */

/** @import { Entry } from './catalogue.js' */

const STYLE = `
  :root { color-scheme: light dark; --line: light-dark(#d5dad8, #3a4147); --soft: light-dark(#5a6670, #a9b3ba); --bad: light-dark(#a4271b, #ff9d8c); --doubt: light-dark(#8a5a00, #f0c060) }
  * { box-sizing: border-box }
  body { margin: 0 auto; padding: 1.5rem; max-width: 1500px; font: 16px/1.45 system-ui, sans-serif }
  header { display: flex; flex-wrap: wrap; gap: .6rem 1.4rem; align-items: baseline; margin-bottom: 1.2rem }
  h1 { margin: 0; font-size: 1.6rem } h2 { margin: 0; font-size: 1rem; overflow-wrap: anywhere }
  input { font: inherit; padding: .35rem .7rem; border: 1px solid var(--line); border-radius: 8px; min-width: 16rem }
  p { margin: .15rem 0; color: var(--soft); font-size: .86rem; overflow-wrap: anywhere }
  .bad { color: var(--bad) } .doubt { color: var(--doubt) }
  ul { display: grid; align-items: start; grid-template-columns: repeat(auto-fill, minmax(var(--least), 1fr)); gap: 1.2rem; margin: 0; padding: 0; list-style: none }
  li { border: 1px solid var(--line); border-radius: 12px; overflow: clip } li > div { padding: .6rem .8rem .8rem }
  li.failed { border: 3px solid var(--bad) } li.doubtful { border-color: var(--doubt) }
  point-weave, .none { display: block; inline-size: 100%; aspect-ratio: 4 / 3; border-radius: 0 }
  .none { display: grid; place-items: center; color: var(--bad); font-size: 1.1rem; background: light-dark(#f6e9e7, #3b2422) }
  img { display: block; width: 100%; height: auto; background: light-dark(#eef1f0, #23292e) }
  dl { display: grid; grid-template-columns: auto 1fr; gap: 0 .7rem; margin: .3rem 0 0; font-size: .82rem } dt { color: var(--soft) } dd { margin: 0; text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums }`;

/** Shows what has all words that are looked for. */
const SEARCH = `
  const field = document.querySelector('input');
  const shown = document.querySelector('output');
  const items = [...document.querySelectorAll('li')];
  const search = () => {
    const words = field.value.toLowerCase().split(/\\s+/);
    for (const item of items) item.hidden = !words.every((word) => item.dataset.text.includes(word));
    shown.value = items.filter((item) => !item.hidden).length + ' of ' + items.length;
  };
  field.addEventListener('input', search);
  search();`;

/** All models, to look at from every side. @param {string} title @param {Entry[]} entries */
export function indexPage(title, entries) {
  const cards = entries.map((entry) => {
    const { name, source } = entry;
    if ('error' in entry) return item(entry, `<div class="none">no model</div><div><h2>${safe(source)}</h2><p class="bad">${safe(entry.error.message)}</p></div>`);
    const { triangles, bytes, doubts } = entry.made;
    const model = `<point-weave src="${name}/model.glb" poster="${name}/poster.png" ar ios-src="${name}/model.usdz" alt="${safe(source)}"></point-weave>`;
    const links = `<p>${whole(triangles)} triangles, ${size(bytes)} · <a href="${name}/model.glb" download="${name}.glb">GLB</a> · <a href="${name}/model.usdz" download="${name}.usdz">USDZ</a> · <a href="${name}/report.json">report</a></p>`;
    return item(entry, `${model}<div><h2>${safe(source)}</h2>${links}${doubtful(doubts)}</div>`);
  });
  const head = `<label>Search <input type="search" autocomplete="off"></label> <output></output> <a href="contact.html">Contact sheet</a>`;
  return page(title, head, cards, '300px', `<script type="module" src="element.min.js"></script>\n<script type="module">${SEARCH}</script>`);
}

/** Pictures and numbers alone, what failed first. @param {string} title @param {Entry[]} entries */
export function contactPage(title, entries) {
  const order = (/** @type {Entry} */ entry) => ('error' in entry ? 0 : entry.made.doubts.length > 0 ? 1 : 2);
  const sorted = [...entries].sort((a, b) => order(a) - order(b));
  const cards = sorted.map((entry) => {
    const { name, source } = entry;
    if ('error' in entry) return item(entry, `<div><h2 class="bad">${safe(source)}</h2><p class="bad">${safe(entry.error.code)}: ${safe(entry.error.message)}</p></div>`);
    const { points, scanBytes, triangles, bytes, rms, lost, doubts, seconds, format } = entry.made;
    const rows = [
      ['scan', `${format}, ${size(scanBytes)}`], ['points', whole(points)], ['triangles', whole(triangles)], ['model', size(bytes)],
      ['points off, rms', percent(rms)], ['triangles cost', percent(lost)], ['time', `${seconds.toFixed(1)} s`],
    ];
    const list = rows.map(([term, value]) => `<dt>${term}</dt><dd>${safe(value)}</dd>`).join('');
    return item(entry, `<img src="${name}/poster.png" alt="" width="800" height="600" loading="lazy"><div><h2>${safe(source)}</h2><dl>${list}</dl>${doubtful(doubts)}</div>`);
  });
  const [failed, doubts] = [0, 1].map((kind) => entries.filter((entry) => order(entry) === kind).length);
  const head = `<p>${entries.length} scans, <span class="${failed ? 'bad' : ''}">${failed} failed</span>, <span class="${doubts ? 'doubt' : ''}">${doubts} doubtful</span>. Points off: how far points are from the surface. Triangles cost: how far the model is from the full mesh, at most. Both in % of the diagonal.</p> <a href="index.html">Models</a>`;
  return page(`${title}: contact sheet`, head, cards, '200px', '');
}

/** @param {string} title @param {string} head @param {string[]} items @param {string} least width of an item @param {string} scripts */
function page(title, head, items, least, scripts) {
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${safe(title)}</title>
<link rel="icon" href="data:,">
<style>${STYLE}
</style>
</head>
<body>
<header><h1>${safe(title)}</h1> ${head}</header>
<main><ul style="--least: ${least}">
${items.join('\n')}
</ul></main>
${scripts}
</body>
</html>
`;
}

/** @param {Entry} entry @param {string} content */
function item(entry, content) {
  const kind = 'error' in entry ? 'failed' : entry.made.doubts.length > 0 ? 'doubtful' : 'fine';
  const words = 'error' in entry ? `${entry.error.code} ${entry.error.message}` : `${entry.made.format} ${entry.made.doubts.join(' ')}`;
  return `<li class="${kind}" data-text="${safe(`${entry.source} ${kind} ${words}`.toLowerCase())}">${content}</li>`;
}

/** @param {string[]} doubts */
function doubtful(doubts) {
  return doubts.map((doubt) => `<p class="doubt">${safe(doubt.replace(/^doubtful: /, ''))}</p>`).join('');
}

/** @param {number} count */
const whole = (count) => count.toLocaleString('en-US');
/** @param {number} share */
const percent = (share) => (share > 0 && share < 1e-5 ? '< 0.001 %' : `${Number((100 * share).toPrecision(2))} %`);
/** @param {number} bytes */
const size = (bytes) => (bytes < 1e6 ? `${Math.round(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`);

/** Text as HTML. @param {string} text */
function safe(text) {
  return text.replace(/[&<>"']/g, (mark) => `&#${mark.charCodeAt(0)};`);
}
