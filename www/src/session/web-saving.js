import { announce, element } from '../dom.js';
import { page } from '../page.js';
import { scaled } from '../measure/lengths.js';
import * as format from '../results/format.js';
import { printingWords, solidOf } from '../results/printing.js';
import { say } from '../words/say.js';
import { saveFile } from './files.js';
import { LightModels, PRESETS, fileOf } from './light-models.js';

/**
 * @import { SurfaceMesh } from 'pointweave'
 * @import { Look } from '../look/look.js'
 * @import { Outcome, Session } from './session.js'
 * @import { Preset } from './light-models.js'
 */

/** Saves what was made for a purpose: a person picks one, sees it beside the scan with its size and error, and saves it. */
export class WebSaving {
  #session;
  #look;
  #fail;
  #models = new LightModels();
  #box = page.web;
  #presets = page.webPresets;
  #words = page.webWords;
  #bar = page.webBar;
  #cancel = page.webCancel;
  #files = page.webFiles;
  /** What models are made of. @type {Outcome | null} */
  #outcome = null;
  /** @type {AbortController | null} */
  #job = null;

  /**
   * @param {Session} session
   * @param {Look} look
   * @param {(error: unknown, name: string) => void} fail
   */
  constructor(session, look, fail) {
    this.#session = session;
    this.#look = look;
    this.#fail = fail;
    for (const [name, preset] of Object.entries(PRESETS)) this.#presets.append(choice(name, preset));
    this.#presets.addEventListener('change', (event) => this.#make(/** @type {HTMLInputElement} */ (event.target).value));
    this.#cancel.addEventListener('click', () => {
      this.#reset();
      announce(say('Cancelled'));
    });
  }

  /** Offers models of what was made; null while there is nothing. @param {Outcome | null} outcome */
  offer(outcome) {
    this.#outcome = outcome?.mesh ? outcome : null;
    this.#box.hidden = !this.#outcome;
    this.#models.of(this.#outcome);
    this.#reset();
  }

  /** Nothing is chosen. */
  #reset() {
    this.#end();
    for (const input of this.#presets.querySelectorAll('input')) input.checked = false;
    this.#words.textContent = '';
    this.#files.replaceChildren();
    this.#look.showLight(null);
  }

  #end() {
    this.#job?.abort();
    this.#job = null;
    this.#bar.hidden = this.#cancel.hidden = true;
  }

  /** @param {string} name of a preset */
  async #make(name) {
    this.#end();
    const job = (this.#job = new AbortController());
    const { signal } = job;
    const preset = PRESETS[name];
    this.#files.replaceChildren();
    this.#words.textContent = preset.light ? say('Making the light model') : '';
    this.#bar.value = 0;
    this.#bar.hidden = this.#cancel.hidden = !preset.light;
    try {
      const model = await this.#models.model(preset, { signal, onProgress: (share) => !signal.aborted && (this.#bar.value = share) });
      if (signal.aborted) return;
      this.#look.showLight(preset.light ? model : null);
      const { words, ready } = this.#told(preset, model);
      this.#words.textContent = words;
      for (const kind of ready ? preset.kinds : []) {
        const file = await fileOf(model, this.#session.scale, kind);
        if (signal.aborted) return;
        this.#files.append(this.#row(kind, file, `${this.#outcome?.scan.file}-${name}.${kind.options.format}`));
      }
    } catch (error) {
      if (signal.aborted) return;
      this.#reset();
      this.#fail(error, say('light model'));
    } finally {
      if (this.#job === job) this.#end();
    }
  }

  /** What is said of a model, and whether it can be saved. @param {Preset} preset @param {SurfaceMesh} model */
  #told({ light, kinds }, model) {
    if (!light) return printingWords(solidOf(scaled(model, this.#session.scale)), model.unit);
    const { report: { triangles, simplified }, textures = {} } = model;
    const { width = 0, height = 0 } = textures.color ?? textures.normal ?? {};
    const words = [say('{triangles} triangles with pictures of {width} × {height}.', { triangles: format.count(triangles), width, height })];
    if (simplified) {
      const { rms, max } = simplified.error;
      words.push(say('Off the full mesh by {rms} of the diagonal (RMS), {max} at most.', { rms: format.percent(rms), max: format.percent(max) }));
    }
    if (!textures.color) words.push(say('The scan has no colours: the picture holds the relief alone.'));
    if (kinds.length > 1 && !model.unit) words.push(say('A coordinate of 1 is taken for a metre. Say its unit below.'));
    return { words: words.join(' '), ready: true };
  }

  /** @param {import('./light-models.js').Kind} kind @param {Blob} file @param {string} title */
  #row({ label, use }, file, title) {
    const button = element('button', { type: 'button', className: 'format' });
    button.append(
      element('span', { className: 'visually-hidden', textContent: `${say('Save the model as')} ` }),
      element('strong', { textContent: label }),
      element('span', { textContent: say(use) }),
      element('data', { textContent: format.bytes(file.size), value: String(file.size) }),
    );
    button.addEventListener('click', () => {
      saveFile(file, title);
      announce(say('{name} saved', { name: title }));
    });
    return button;
  }
}

/** @param {string} name @param {Preset} preset */
function choice(name, { label, light, kinds }) {
  const row = element('label', { className: 'preset' });
  const words = light && kinds.length < 2
    ? say('{triangles} triangles, {size} px', { triangles: format.count(light.triangles), size: light.size })
    : kinds.map((kind) => kind.label).join(', ');
  row.append(
    element('input', { type: 'radio', name: 'preset', value: name }),
    element('strong', { textContent: say(label) }),
    element('span', { textContent: words }),
  );
  return row;
}
