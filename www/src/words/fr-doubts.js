/** What may be wrong with a result, in French, by the English texts. @type {Record<string, string>} */
export default {
  'Which side is out is a guess for {share} of the surface.': 'Le côté extérieur est deviné pour {share} de la surface.',
  'What is known of the outer side contradicts itself or the surface over {share} of it.': 'Ce que l’on sait du côté extérieur se contredit, ou contredit la surface, sur {share} de celle-ci.',
  '{share} of what the scanner saw shows its inner side.': '{share} de ce que le scanner a vu montre le côté intérieur.',
  'Next to nothing ties {share} of the surface to the rest: it may be inside out.': 'Presque rien ne relie {share} de la surface au reste : elle y est peut-être retournée.',
  'The mesh is not close to the points: there are too few of them to tell where the surface is, or some lie far from the rest.': 'Le maillage n’est pas près des points : ils sont trop peu nombreux pour situer la surface, ou certains sont loin des autres.',
  'The coordinates were rounded to steps: detail as fine as they are is smoothed away.': 'Les coordonnées ont été arrondies par paliers : les détails aussi fins sont lissés.',
  'x and y look like degrees of longitude and latitude, and z like metres: convert the scan to a projected coordinate system first.': 'x et y ressemblent à des degrés de longitude et de latitude, z à des mètres : convertir d’abord le scan en coordonnées projetées.',
  '{share} of the points are on scan lines much farther apart than the points of a line: the surface between lines is drawn from one to the next.': '{share} des points sont sur des lignes de balayage bien plus espacées que les points d’une ligne : entre elles, la surface est tirée de l’une à l’autre.',
  'The file is a mesh: its points were taken from its faces, evenly over their area.': 'Le fichier est un maillage : ses points ont été pris sur ses faces, uniformément.',
  '{share} of the points lie as in foliage, dust or a filled volume, with no surface through them.': '{share} des points sont comme dans du feuillage, de la poussière ou un volume plein : aucune surface n’y passe.',
  '{share} of the surface belongs to walls that are about as thin as the points are apart, or as the noise: their shape is not known there.': '{share} de la surface appartient à des parois aussi minces que l’écart des points, ou que le bruit : leur forme n’y est pas connue.',
  '{share} of the area is far from any point.': '{share} de la surface est loin de tout point.',
  'The surface has many tunnels: the points do not tell well what is inside.': 'La surface a beaucoup de tunnels : les points disent mal ce qui est dedans.',
  'Some triangles cross others.': 'Des triangles en croisent d’autres.',
  'Pieces too small to be a surface were left out: {share} of the points.': 'Des morceaux trop petits pour être une surface ont été laissés : {share} des points.',
};
