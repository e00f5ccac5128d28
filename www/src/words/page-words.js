import { say, words } from './say.js';

const SAID = ['title', 'aria-label', 'placeholder'];

/** Says the texts that stand in the page itself in the person's language. */
export function translatePage() {
  if (words.language === 'en') return;
  document.documentElement.lang = words.language;
  document.title = say(document.title);
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode()) {
    const text = node.nodeValue ?? '';
    const bare = text.trim().replace(/\s+/g, ' ');
    if (bare in words.table) node.nodeValue = `${/^\s/.test(text) ? ' ' : ''}${say(bare)}${/\s$/.test(text) ? ' ' : ''}`;
  }
  for (const name of SAID) {
    for (const element of document.querySelectorAll(`[${name}]`)) element.setAttribute(name, say(element.getAttribute(name) ?? ''));
  }
}
