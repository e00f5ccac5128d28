/** The style sheet, shared by all elements. Constructed, so that `style-src 'self'` does not stand in its way. */

import { PANELS } from './panels-sheet.js';

const CSS = /* css */ `
  :host {
    display: inline-block;
    position: relative;
    inline-size: 300px;
    aspect-ratio: 4 / 3;
    overflow: clip;
    border-radius: 12px;
    contain: layout style paint;
    background: var(--point-weave-background, linear-gradient(#f2f4f3, #d9dfde));
    --ink: var(--point-weave-color, #1b2329);
    --card: var(--point-weave-card, #fdfcf9);
    --accent: var(--point-weave-accent, #0b6e69);
    --on-accent: var(--point-weave-on-accent, #ffffff);
    --warn: var(--point-weave-warn, #a43c17);
    --mesh: var(--point-weave-mesh, #f1e7d8);
    --points: var(--point-weave-points, #5d7f93);
    --reduced: var(--point-weave-reduced, #0f8c84);
    color: var(--ink);
    font: var(--point-weave-font, 15px/1.4 system-ui, sans-serif);
  }

  /* Follows the page's own color-scheme, not the device's: a light page stays light. */
  @supports (color: light-dark(#000, #fff)) {
    :host {
      background: var(--point-weave-background, linear-gradient(light-dark(#f2f4f3, #2b3136), light-dark(#d9dfde, #15181b)));
      --ink: var(--point-weave-color, light-dark(#1b2329, #ebe8e1));
      --card: var(--point-weave-card, light-dark(#fdfcf9, #272d32));
      --accent: var(--point-weave-accent, light-dark(#0b6e69, #62cbbf));
      --on-accent: var(--point-weave-on-accent, light-dark(#ffffff, #06221f));
      --warn: var(--point-weave-warn, light-dark(#a43c17, #f0a183));
      --mesh: var(--point-weave-mesh, light-dark(#f1e7d8, #efe3d2));
      --points: var(--point-weave-points, light-dark(#5d7f93, #9fc0d2));
      --reduced: var(--point-weave-reduced, light-dark(#0f8c84, #5fd0c4));
    }
  }

  :host([hidden]), [hidden] {
    display: none !important;
  }

  * {
    box-sizing: border-box;
  }

  .frame {
    position: absolute;
    inset: 0;
    container-type: size;
  }

  /* The layers' colours are looked up here (colors.js); a transition tells when they change. */
  canvas {
    position: absolute;
    inset: 0;
    inline-size: 100%;
    block-size: 100%;
    border-radius: inherit;
    color: var(--mesh);
    caret-color: var(--points);
    column-rule-color: var(--reduced);
    transition: color 1ms, caret-color 1ms, column-rule-color 1ms;
    -webkit-user-select: none;
    user-select: none;
  }

  canvas[tabindex] {
    cursor: grab;
  }

  canvas[tabindex]:active {
    cursor: grabbing;
  }

  :focus {
    outline: none;
  }

  :focus-visible {
    outline: 3px solid var(--accent);
    outline-offset: 2px;
  }

  canvas:focus-visible {
    outline-offset: -3px;
    border-radius: 12px;
  }

  .hotspots {
    position: absolute;
    inset: 0;
    overflow: clip;
    pointer-events: none;
  }

  .hotspot {
    position: absolute;
    inset: 0 auto auto 0;
    pointer-events: auto;
  }

  .hotspot.behind {
    opacity: var(--min-hotspot-opacity, 0.25);
    pointer-events: none;
  }

  .prompt {
    position: absolute;
    inset: 0;
    display: grid;
    place-items: center;
    pointer-events: none;
  }

  .prompt svg {
    inline-size: 40px;
    block-size: 40px;
    padding: 6px;
    border-radius: 50%;
    background: var(--card);
    fill: none;
    stroke: var(--ink);
    stroke-width: 1.4;
    stroke-linecap: round;
    stroke-linejoin: round;
  }

  .poster {
    position: absolute;
    inset: 0;
    opacity: 1;
    pointer-events: none;
  }

  .poster.gone {
    opacity: 0;
    visibility: hidden;
  }

  .poster img, ::slotted([slot='poster']) {
    display: block;
    inline-size: 100%;
    block-size: 100%;
    object-fit: var(--point-weave-poster-fit, contain);
  }

  ::slotted([slot='poster']) {
    pointer-events: auto;
  }

  :host(:fullscreen) {
    border-radius: 0;
  }

  @media (prefers-reduced-motion: no-preference) {
    .poster {
      transition: opacity 0.35s, visibility 0.35s;
    }

    .views span, .button {
      transition: background-color 0.15s, color 0.15s;
    }

    .prompt svg {
      animation: swaying 2.4s ease-in-out infinite alternate;
    }

    progress:indeterminate {
      animation: waiting 0.9s ease-in-out infinite alternate;
    }
  }

  @keyframes swaying {
    from {
      transform: translateX(-24px);
    }

    to {
      transform: translateX(24px);
    }
  }

  @keyframes waiting {
    to {
      background: color-mix(in srgb, var(--accent) 60%, var(--card));
    }
  }

  @media (forced-colors: active) {
    .views input:checked + span {
      forced-color-adjust: none;
      background: Highlight;
      color: HighlightText;
    }

    canvas {
      forced-color-adjust: none;
    }
  }
`;

/** @type {CSSStyleSheet | undefined} */
let sheet;

export function sharedSheet() {
  if (!sheet) {
    sheet = new CSSStyleSheet();
    sheet.replaceSync(PANELS + CSS);
  }
  return sheet;
}
