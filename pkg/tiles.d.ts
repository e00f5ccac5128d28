/** Lets a bundler see 3d-tiles-renderer, an optional peer dependency: `import 'pointweave/tiles'` where tilesets are shown. */
export {};
