/**
 * Tells those who listen what happened. `Events` says for each event what is handed over.
 * @template {Record<string, any>} Events
 */
export class Emitter {
  /** @type {Map<keyof Events, ((detail: any) => void)[]>} */
  #heard = new Map();

  /**
   * @template {keyof Events} Name
   * @param {Name} name
   * @param {(detail: Events[Name]) => void} act
   */
  on(name, act) {
    this.#heard.set(name, [...(this.#heard.get(name) ?? []), act]);
  }

  /**
   * @template {keyof Events} Name
   * @param {Name} name
   * @param {Events[Name]} detail
   */
  emit(name, detail) {
    for (const act of this.#heard.get(name) ?? []) act(detail);
  }
}
