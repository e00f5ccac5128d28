/** The style sheet, shared by all elements. Constructed, so that `style-src 'self'` does not stand in its way. */

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

  .progress, .error {
    position: absolute;
    inset-inline: 12px;
    inset-block-start: 12px;
    margin-inline: auto;
    max-inline-size: 420px;
    border-radius: 14px;
    background: var(--card);
    box-shadow: 0 1px 2px rgb(20 30 35 / 10%), 0 6px 24px rgb(20 30 35 / 14%);
  }

  .progress-card {
    display: grid;
    grid-template-columns: minmax(0, 1fr) auto;
    gap: 8px 12px;
    align-items: center;
    padding: 12px 16px;
  }

  .progress-text {
    overflow: hidden;
    text-overflow: ellipsis;
    white-space: nowrap;
  }

  progress {
    grid-column: 1;
    inline-size: 100%;
    block-size: 6px;
    border: 0;
    border-radius: 3px;
    overflow: hidden;
    background: color-mix(in srgb, var(--accent) 18%, transparent);
    appearance: none;
  }

  progress::-webkit-progress-bar {
    background: transparent;
  }

  progress::-webkit-progress-value {
    border-radius: 3px;
    background: var(--accent);
  }

  progress::-moz-progress-bar {
    background: var(--accent);
  }

  .cancel {
    grid-column: 2;
    grid-row: 1 / span 2;
  }

  /* Without controls: a line along the lower edge. */
  .progress.bare {
    inset: auto 0 0;
    max-inline-size: none;
    border-radius: 0;
    background: none;
    box-shadow: none;
  }

  .bare .progress-card {
    display: block;
    padding: 0;
  }

  .bare .progress-text, .bare .cancel {
    display: none;
  }

  .bare progress {
    display: block;
    block-size: 4px;
    border-radius: 0;
    background: color-mix(in srgb, var(--accent) 25%, var(--card));
  }

  .error {
    z-index: 1;
    inset-block: 0;
    block-size: fit-content;
    max-block-size: calc(100% - 24px);
    margin-block: auto;
    overflow: auto;
    border-block-start: 4px solid var(--warn);
  }

  .error-card {
    display: grid;
    justify-items: start;
    gap: 6px;
    padding: 16px 18px;
  }

  .error-card p {
    margin: 0;
    overflow-wrap: anywhere;
  }

  .error-title {
    font-weight: 600;
  }

  .error-text {
    font-size: 0.88em;
  }

  .toolbar {
    position: absolute;
    inset-inline: 0;
    inset-block-end: 10px;
    display: flex;
    justify-content: center;
    align-items: center;
    gap: 6px;
    padding-inline: 8px;
    pointer-events: none;
  }

  :host(:fullscreen) {
    border-radius: 0;
  }

  .toolbar.bare {
    justify-content: flex-end;
  }

  .toolbar > *, ::slotted([slot='toolbar']) {
    pointer-events: auto;
  }

  .views, .tools {
    display: flex;
    margin: 0;
    padding: 3px;
    border: 0;
    border-radius: 14px;
    background: var(--card);
    box-shadow: 0 1px 2px rgb(20 30 35 / 8%), 0 4px 16px rgb(20 30 35 / 10%);
  }

  .views legend, .views input, .spoken {
    position: absolute;
    inline-size: 1px;
    block-size: 1px;
    margin: -1px;
    overflow: hidden;
    clip-path: inset(50%);
    white-space: nowrap;
    opacity: 0;
  }

  .views label {
    display: block;
  }

  .views span {
    display: grid;
    place-items: center;
    min-block-size: 44px;
    padding-inline: 16px;
    border-radius: 11px;
    font-weight: 550;
    cursor: pointer;
  }

  .views span:hover, .button:hover {
    background: color-mix(in srgb, var(--accent) 14%, transparent);
  }

  .views input:checked + span {
    background: var(--accent);
    color: var(--on-accent);
  }

  .views input:focus-visible + span {
    outline: 3px solid var(--accent);
    outline-offset: 2px;
  }

  .button {
    display: grid;
    place-items: center;
    min-inline-size: 44px;
    min-block-size: 44px;
    padding: 0 8px;
    border: 0;
    border-radius: 11px;
    background: transparent;
    color: inherit;
    font: inherit;
    font-weight: 550;
    cursor: pointer;
  }

  .cancel, .retry {
    padding-inline: 16px;
    background: color-mix(in srgb, var(--accent) 12%, transparent);
  }

  .retry {
    margin-block-start: 6px;
  }

  .button svg {
    inline-size: 20px;
    block-size: 20px;
    fill: none;
    stroke: currentcolor;
    stroke-width: 1.8;
    stroke-linecap: round;
    stroke-linejoin: round;
  }

  /* Where there is little room. */
  @container (max-width: 460px) {
    .views span {
      padding-inline: 9px;
      font-size: 0.9em;
    }

    .fullscreen {
      display: none;
    }
  }

  @container (max-width: 290px) {
    .toolbar {
      gap: 3px;
      padding-inline: 3px;
    }

    .views span {
      padding-inline: 5px;
      font-size: 0.78em;
    }

    .reset {
      display: none;
    }

    .tools {
      padding: 0;
    }
  }

  @container (max-height: 200px) {
    .error-text {
      font-size: 0.8em;
    }
  }

  @media (prefers-reduced-motion: no-preference) {
    .poster {
      transition: opacity 0.35s, visibility 0.35s;
    }

    .views span, .button {
      transition: background-color 0.15s, color 0.15s;
    }

    progress:indeterminate {
      animation: waiting 0.9s ease-in-out infinite alternate;
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
    sheet.replaceSync(CSS);
  }
  return sheet;
}
