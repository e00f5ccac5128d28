/** What the package says of itself, in French, by the English. @type {Record<string, string>} */
export default {
  'one thread was asked for': 'un seul fil a été demandé',
  'threads need a worker': 'les fils d’exécution demandent un worker',
  'there is one processor core': 'il y a un seul cœur de processeur',
  'the page is cross-origin isolated': 'la page est isolée des autres origines',
  'the page is not cross-origin isolated': 'la page n’est pas isolée des autres origines, ce que demandent les fils',
  'the threads build did not start: {why}': 'la version à plusieurs fils n’a pas démarré : {why}',
  'memory is limited to {size} MiB here': 'la mémoire est limitée à {size} Mio ici',
  'the points are at {places} places: each is kept once': 'les points sont à {places} endroits : chacun est gardé une fois',
  'noise of {noise} hides a surface within {asked}: the tolerance was taken as {taken}': 'un bruit de {noise} cache une surface à {asked} : la tolérance a été {taken}',
  '{dropped} points, more than half, are isolated: none was dropped': '{dropped} points, plus de la moitié, sont isolés : aucun n’a été retiré',
};
