/** What the package says of itself, in German, by the English. @type {Record<string, string>} */
export default {
  'one thread was asked for': 'ein Thread war verlangt',
  'threads need a worker': 'Threads brauchen einen Worker',
  'there is one processor core': 'es gibt einen Prozessorkern',
  'the page is cross-origin isolated': 'die Seite ist ursprungsübergreifend isoliert',
  'the page is not cross-origin isolated': 'die Seite ist nicht ursprungsübergreifend isoliert, Threads gibt es nur dann',
  'the threads build did not start: {why}': 'die Fassung mit Threads startete nicht: {why}',
  'memory is limited to {size} MiB here': 'der Speicher ist hier auf {size} MiB begrenzt',
  'the points are at {places} places: each is kept once': 'die Punkte liegen an {places} Orten: jeder bleibt einmal',
  'noise of {noise} hides a surface within {asked}: the tolerance was taken as {taken}': 'Rauschen von {noise} verdeckt eine Fläche bis {asked}: als Toleranz galt {taken}',
  '{dropped} points, more than half, are isolated: none was dropped': '{dropped} Punkte, mehr als die Hälfte, sind vereinzelt: keiner fiel weg',
};
