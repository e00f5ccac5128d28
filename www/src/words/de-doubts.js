/** What may be wrong with a result, in German, by the English texts. @type {Record<string, string>} */
export default {
  'Which side is out is a guess for {share} of the surface.': 'Welche Seite außen ist, ist für {share} der Fläche geraten.',
  'What is known of the outer side contradicts itself or the surface over {share} of it.': 'Was über die Außenseite bekannt ist, widerspricht sich oder der Fläche auf {share} davon.',
  '{share} of what the scanner saw shows its inner side.': '{share} von dem, was der Scanner sah, zeigt die Innenseite.',
  'Next to nothing ties {share} of the surface to the rest: it may be inside out.': 'Fast nichts verbindet {share} der Fläche mit dem Rest: Innen und außen können dort vertauscht sein.',
  'The mesh is not close to the points: there are too few of them to tell where the surface is, or some lie far from the rest.': 'Das Netz liegt nicht nahe an den Punkten: Es sind zu wenige, um die Fläche zu erkennen, oder einige liegen weit ab.',
  'The coordinates were rounded to steps: detail as fine as they are is smoothed away.': 'Die Koordinaten wurden auf Stufen gerundet: So feine Einzelheiten sind geglättet.',
  'x and y look like degrees of longitude and latitude, and z like metres: convert the scan to a projected coordinate system first.': 'x und y sehen nach Längen- und Breitengraden aus, z nach Metern: Den Scan zuerst in ein projiziertes Koordinatensystem umrechnen.',
  '{share} of the points are on scan lines much farther apart than the points of a line: the surface between lines is drawn from one to the next.': '{share} der Punkte liegen auf Scanzeilen, die viel weiter auseinander sind als die Punkte einer Zeile: Dazwischen ist die Fläche von Zeile zu Zeile gezogen.',
  'The file is a mesh: its points were taken from its faces, evenly over their area.': 'Die Datei ist ein Netz: Die Punkte wurden gleichmäßig von seinen Flächen genommen.',
  '{share} of the points lie as in foliage, dust or a filled volume, with no surface through them.': '{share} der Punkte liegen wie in Laub, Staub oder einem gefüllten Körper: Durch sie geht keine Fläche.',
  '{share} of the surface belongs to walls that are about as thin as the points are apart, or as the noise: their shape is not known there.': '{share} der Fläche gehören zu Wänden, die etwa so dünn sind wie der Punktabstand oder das Rauschen: Ihre Form ist dort nicht bekannt.',
  '{share} of the area is far from any point.': '{share} der Fläche sind weit von jedem Punkt.',
  'The surface has many tunnels: the points do not tell well what is inside.': 'Die Fläche hat viele Tunnel: Die Punkte sagen nicht klar, was innen ist.',
  'Some triangles cross others.': 'Einige Dreiecke schneiden andere.',
  'Pieces too small to be a surface were left out: {share} of the points.': 'Stücke, die zu klein für eine Fläche sind, fehlen: {share} der Punkte.',
};
