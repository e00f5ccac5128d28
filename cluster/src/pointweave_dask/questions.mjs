/** Answers for Python, as JSON, of the npm package's own code: `node questions.mjs PACKAGE QUESTION < [arguments]`. */
import { text } from 'node:stream/consumers';
import { pathToFileURL } from 'node:url';

const [home, question] = process.argv.slice(2);
const from = (path) => import(pathToFileURL(`${home}/${path}`).href);
const { contactPage, indexPage } = await from('cli/catalogue-page.js');
const { namesOf } = await from('cli/catalogue.js');
const { optionsOf, parse } = await from('cli/arguments.js');
const { isScan } = await from('files/archive.js');

const ANSWERS = {
  /** The flags of a command, as `parseArgs` is told of them. */
  flags: (command) => optionsOf(command),
  /** Whatever is wrong with a command line. */
  check(argv) {
    try {
      parse(argv);
      return null;
    } catch (error) {
      return error.message;
    }
  },
  /** Those files that are scans by their names. */
  scans: (names) => names.filter(isScan),
  /** The folders that a catalogue gives to its scans. */
  names: (sources) => namesOf(sources),
  /** What a catalogue has beside the folders of its scans; the list of what was made comes last. */
  pages: (title, entries) => ({
    'index.html': indexPage(title, entries),
    'contact.html': contactPage(title, entries),
    'catalogue.json': `${JSON.stringify(entries, null, 1)}\n`,
  }),
};

process.stdout.write(JSON.stringify(ANSWERS[question](...JSON.parse(await text(process.stdin)))));
