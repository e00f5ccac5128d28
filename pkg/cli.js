#!/usr/bin/env node
/** The command line: `npx pointweave reduce|reconstruct|prepare|merge|simplify|poster|catalogue|inspect`. */
import { main } from './cli/main.js';

process.exitCode = await main(process.argv.slice(2));
