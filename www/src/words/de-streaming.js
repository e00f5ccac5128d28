/** Texts of the page with a tileset in German, by the English ones. @type {Record<string, string>} */
export default {
  'A tileset, streamed': 'Ein Kachelsatz, gestreamt',
  'Near the camera it is fine, far away coarse. It can be looked at and measured; to reduce or save a scan, open one.': 'Nah an der Kamera ist er fein, in der Ferne grob. Er lässt sich ansehen und messen; um einen Scan zu reduzieren oder zu speichern, öffnen Sie einen.',
  'Points shown': 'Gezeigte Punkte',
  'Points in all': 'Punkte insgesamt',
  'Tiles in the picture': 'Kacheln im Bild',
  'Tiles under way': 'Kacheln unterwegs',
  'Tiles that did not come': 'Kacheln, die nicht kamen',
  'Memory held': 'Belegter Speicher',
  '{name} is shown': '{name} wird gezeigt',
  '{count} triangles shown': '{count} Dreiecke gezeigt',
  '{shown} of {total} points shown': '{shown} von {total} Punkten gezeigt',
  '{shown} points shown': '{shown} Punkte gezeigt',
  '{held} of {budget}': '{held} von {budget}',
};
