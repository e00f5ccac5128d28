/** Texts of the page with a tileset in French, by the English ones. @type {Record<string, string>} */
export default {
  'A tileset, streamed': 'Un jeu de tuiles, diffusé en continu',
  'Near the camera it is fine, far away coarse. It can be looked at and measured; to reduce or save a scan, open one.': 'Près de la caméra il est fin, au loin grossier. On peut le regarder et y mesurer ; pour réduire ou enregistrer un scan, ouvrez-en un.',
  'Points shown': 'Points affichés',
  'Points in all': 'Points en tout',
  'Tiles in the picture': 'Tuiles dans l’image',
  'Tiles under way': 'Tuiles en chemin',
  'Tiles that did not come': 'Tuiles non arrivées',
  'Memory held': 'Mémoire occupée',
  '{name} is shown': '{name} est affiché',
  '{count} triangles shown': '{count} triangles affichés',
  '{shown} of {total} points shown': '{shown} points affichés sur {total}',
  '{shown} points shown': '{shown} points affichés',
  '{held} of {budget}': '{held} sur {budget}',
};
