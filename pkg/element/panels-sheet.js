/** The style of what lies over the picture: progress, error, toolbar. */

export const PANELS = /* css */ `
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

  .error-text, .error-details {
    font-size: 0.88em;
  }

  .error-details summary {
    min-block-size: 24px;
    cursor: pointer;
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

  .ar {
    position: absolute;
    inset: 10px 10px auto auto;
    border-radius: 14px;
    background: var(--card);
    box-shadow: 0 1px 2px rgb(20 30 35 / 8%), 0 4px 16px rgb(20 30 35 / 10%);
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

  }

  /* Views below, tools in the upper corner. */
  @container (max-width: 400px) {
    .toolbar:not(.bare) {
      inset-block: 6px;
      align-items: end;
      padding-inline: 3px;
    }

    .toolbar:not(.bare) .tools {
      position: absolute;
      inset-block-start: 0;
      inset-inline-end: 6px;
      padding: 0;
    }

    .views span {
      padding-inline: 7px;
      font-size: 0.85em;
    }

    .progress, .error {
      inset-inline: 6px;
    }

    .error-card {
      padding: 10px 12px;
      font-size: 0.9em;
    }
  }

  @container (max-height: 200px) {
    .error-text {
      font-size: 0.8em;
    }
  }
`;
