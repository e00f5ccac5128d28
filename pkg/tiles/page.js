/** A page that streams the tileset beside it, for any static server. */

/** What the page loads from its own folder: the element in one file, and what streams. */
export const SCRIPTS = ['element.min.js', 'element-tiles.min.js'];

/** @param {import('./plan.js').Plan} plan */
export function pageOf({ inputs }) {
  const [{ name }] = inputs;
  const title = inputs.length === 1 ? name : `${name} and ${inputs.length - 1} more`;
  const safe = title.replace(/[&<>"]/g, (mark) => `&#${mark.charCodeAt(0)};`);
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${safe}</title>
<style>
  :root { color-scheme: light dark }
  body { margin: 0; font: 14px/1.4 system-ui, sans-serif }
  point-weave { display: block; width: 100vw; height: 100vh; height: 100dvh; border-radius: 0 }
  output { position: fixed; inset: auto auto .6rem .8rem; padding: .15rem .5rem; border-radius: 6px; background: Canvas; opacity: .85 }
</style>
<point-weave src="tileset.json" alt="${safe}" controls loading="eager"></point-weave>
<output></output>
<script type="module" src="element.min.js"></script>
<script type="module">
  const shown = document.querySelector('output');
  document.querySelector('point-weave').addEventListener('stream', ({ detail: { points, triangles, total, bytes } }) => {
    const what = triangles ? triangles.toLocaleString() + ' triangles' : points.toLocaleString() + (total ? ' of ' + total.toLocaleString() : '') + ' points';
    shown.value = what + ', ' + Math.round(bytes / 1e6) + ' MB';
  });
</script>
</html>
`;
}
