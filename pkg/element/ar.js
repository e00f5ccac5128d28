/**
 * What is shown, in the room around the visitor: Scene Viewer on Android, which fetches the GLB itself, and Quick Look on iPhone and iPad,
 * which takes a USDZ file. The button is there only where one of them is.
 */
import { SOURCE } from './room.js';

const MODES = 'webxr scene-viewer quick-look';
/** Where Scene Viewer sends those back who do not have it. */
const FAILED = '#point-weave-no-ar';

export class Ar {
  /** The element. */
  #host;
  #box;
  /** The address of a USDZ file that was made, and of what. @type {{ of: unknown, href: string } | undefined} */
  #made;

  /** @param {import('./room.js').InRoom} host */
  constructor(host) {
    this.#host = host;
    this.#box = /** @type {HTMLElement} */ (host.shadowRoot?.querySelector('.ar'));
    this.#box.addEventListener('click', () => this.open());
  }

  /** Shows it in the room, where a visitor has just clicked. */
  async open() {
    const { mode } = this;
    const button = /** @type {HTMLButtonElement} */ (this.#box.querySelector('button'));
    if (!mode || button.disabled) return;
    button.disabled = true;
    try {
      if (mode === 'scene-viewer') this.#openSceneViewer();
      else await this.#openQuickLook();
    } catch {
      this.#fail();
    } finally {
      button.disabled = false;
    }
  }

  /** Shows the button, or hides it. */
  offer() {
    this.#box.hidden = !this.mode;
    if (this.#made && this.#made.of !== this.#subject) this.#drop();
  }

  /** What there is to show: a GLB, or the mesh of a scan. */
  get #subject() {
    const source = this.#host[SOURCE];
    return source?.kind === 'scan' ? source.mesh : source?.kind === 'glb' ? source : undefined;
  }

  /** How it is shown on this device; null where it cannot be. @returns {'scene-viewer' | 'quick-look' | null} */
  get mode() {
    const { ar, src, arModes, iosSrc } = this.#host;
    if (!ar || !src) return null;
    const wanted = (arModes || MODES).split(/\s+/);
    const can = {
      'scene-viewer': isAndroid() && this.#host[SOURCE]?.kind === 'glb',
      'quick-look': hasQuickLook() && Boolean(iosSrc || this.#subject),
    };
    const found = /** @type {(keyof typeof can)[]} */ (wanted).find((mode) => can[mode]);
    // As model-viewer has it: a file for iOS goes before the list.
    return found ?? (iosSrc && can['quick-look'] ? 'quick-look' : null);
  }

  #openSceneViewer() {
    const { src, arScale, arPlacement } = this.#host;
    const model = new URL(src, document.baseURI);
    model.hash = '';
    const params = new URLSearchParams(model.search);
    params.set('mode', 'ar_preferred');
    if (!params.has('disable_occlusion')) params.set('disable_occlusion', 'true');
    if (arScale === 'fixed') params.set('resizable', 'false');
    if (arPlacement === 'wall') params.set('enable_vertical_placement', 'true');
    const back = new URL(location.href);
    back.hash = FAILED;
    addEventListener('hashchange', () => {
      if (location.hash !== FAILED) return;
      history.back();
      this.#fail();
    }, { once: true });
    const intent = `#Intent;scheme=https;package=com.google.android.googlequicksearchbox;action=android.intent.action.VIEW;S.browser_fallback_url=${encodeURIComponent(back.href)};end;`;
    this.#follow(`intent://arvr.google.com/scene-viewer/1.2?${params}&file=${encodeURIComponent(model.href)}${intent}`);
  }

  async #openQuickLook() {
    const { iosSrc, arScale } = this.#host;
    const file = new URL(iosSrc || (await this.#usdz()), document.baseURI);
    if (arScale === 'fixed') file.hash += `${file.hash ? '&' : ''}allowsContentScaling=0`;
    this.#follow(file.href, { rel: 'ar', ...(!iosSrc && { download: 'model.usdz' }) });
  }

  /** The address of a file with what is shown, made once. */
  async #usdz() {
    const subject = /** @type {import('./source.js').Glb | import('../types.js').SurfaceMesh} */ (this.#subject);
    if (this.#made?.of === subject) return this.#made.href;
    const { wasmUrl, workerUrl } = /** @type {typeof import('./element.js').PointWeaveElement} */ (this.#host.constructor);
    const { usdzOf } = await import('./usdz.js');
    const blob = new Blob([await usdzOf(subject, { threads: 1, wasmUrl, workerUrl })], { type: 'model/vnd.usdz+zip' });
    this.#drop();
    this.#made = { of: subject, href: URL.createObjectURL(blob) };
    return this.#made.href;
  }

  /** Quick Look wants a picture in the link, and the link in the page. @param {string} href @param {{ rel?: string, download?: string }} [more] */
  #follow(href, more) {
    const link = Object.assign(document.createElement('a'), { href, hidden: true, ...more });
    link.append(document.createElement('img'));
    this.#host.shadowRoot?.append(link);
    link.click();
    link.remove();
  }

  #drop() {
    if (this.#made) URL.revokeObjectURL(this.#made.href);
    this.#made = undefined;
  }

  #fail() {
    this.#host.dispatchEvent(new CustomEvent('ar-status', { detail: { status: 'failed' } }));
  }
}

function isAndroid() {
  return /android/i.test(navigator.userAgent) && !/firefox|OculusBrowser/i.test(navigator.userAgent);
}

/** iPadOS calls itself a Mac, of which none has more than one finger. Browsers that are not Safari do not say that they can, but can. */
function hasQuickLook() {
  const { userAgent, platform, maxTouchPoints } = navigator;
  if (!/iPad|iPhone|iPod/.test(userAgent) && !(platform === 'MacIntel' && maxTouchPoints > 1)) return false;
  if (/GSA\//.test(userAgent)) return false;
  return /CriOS\/|EdgiOS\/|FxiOS\/|DuckDuckGo\//.test(userAgent) || Boolean(document.createElement('a').relList?.supports?.('ar'));
}
