/** Loaded before the command line: ends it when the worker that started it is gone, since standard input ends with that. */
process.stdin.once('end', () => process.exit(1)).resume().unref();
