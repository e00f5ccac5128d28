/** The script of a browser's worker, for `workerUrl`: a module that answers messages and exports nothing. */
export {};
