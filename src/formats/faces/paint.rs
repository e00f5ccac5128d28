//! Colours of points on triangles: of the vertices, of the triangles, of materials and of their textures.

use super::looks::{Look, Picture, Texture, Wrap};
use super::triangles::{Faces, NONE, Source};
use crate::base::srgb::{linear, srgb};
use crate::formats::raw_cloud::RawCloud;
use crate::formats::text::words;

pub(super) struct Painter<'a> {
    faces: &'a Faces,
    vertices: &'a RawCloud,
}

impl Painter<'_> {
    /// `None` where nothing has a colour.
    pub(super) fn of<'a>(faces: &'a Faces, vertices: &'a RawCloud) -> Option<Painter<'a>> {
        let shows = |look: &Look| {
            look.factor.is_some_and(|factor| factor != [1.0; 3])
                || look
                    .texture
                    .as_ref()
                    .is_some_and(|texture| open(faces, texture).is_some())
        };
        let colored = vertices.colors.is_some()
            || !faces.colors.is_empty()
            || (!faces.look_of.is_empty() && faces.looks.iter().any(shows));
        colored.then_some(Painter { faces, vertices })
    }

    /// The colour of a point, 0-255; `None` where the texture has a hole.
    pub(super) fn color(&self, triangle: usize, weights: [f64; 3]) -> Option<[f64; 3]> {
        let own = self.own(triangle, weights);
        let look = self
            .faces
            .look_of
            .get(triangle)
            .and_then(|&i| self.faces.looks.get(i as usize));
        let Some(look) = look else {
            return Some(own.unwrap_or([255.0; 3]));
        };
        let texel = look
            .texture
            .as_ref()
            .and_then(|texture| self.texel(texture, triangle, weights));
        if let (Some(cutoff), Some([_, _, _, alpha])) = (look.cutoff, texel)
            && alpha < 255.0 * cutoff
        {
            return None;
        }
        let layers = [own, texel.map(|[r, g, b, _]| [r, g, b])];
        let factor = look.factor.unwrap_or([1.0; 3]);
        if let ([Some(layer), None] | [None, Some(layer)], true) = (layers, factor == [1.0; 3]) {
            return Some(layer);
        }
        Some([0, 1, 2].map(|k| {
            let shares = layers.iter().flatten().map(|layer| layer[k] / 255.0);
            if look.linear {
                255.0 * srgb(shares.map(linear).product::<f64>() * factor[k])
            } else {
                255.0 * shares.product::<f64>() * factor[k]
            }
        }))
    }

    /// The mean of the vertices' colours, or the triangle's.
    fn own(&self, triangle: usize, weights: [f64; 3]) -> Option<[f64; 3]> {
        if let Some(color) = self.faces.colors.get(triangle) {
            return Some(color.map(f64::from));
        }
        let colors = self.vertices.colors.as_ref()?;
        let corners = self.faces.corners[triangle];
        Some([0, 1, 2].map(|k| {
            (0..3)
                .map(|corner| weights[corner] * f64::from(colors[3 * corners[corner] as usize + k]))
                .sum()
        }))
    }

    /// Red, green, blue and alpha of the texture.
    fn texel(&self, texture: &Texture, triangle: usize, weights: [f64; 3]) -> Option<[f64; 4]> {
        let picture = open(self.faces, texture)?;
        let corners = match self.faces.place_corners.get(triangle) {
            Some(corners) => corners,
            None => &self.faces.corners[triangle],
        };
        if corners.contains(&NONE) {
            return None;
        }
        let mut at = [0.0; 2];
        for (corner, weight) in corners.iter().zip(weights) {
            let place = self.faces.places.get(*corner as usize)?;
            (0..2).for_each(|k| at[k] += weight * f64::from(place[k]));
        }
        let size = [picture.width, picture.height];
        let at = texture.place(at);
        let place = [0, 1].map(|k| at[k] * size[k] as f64);
        let pixel = |x: f64, y: f64| {
            let [x, y] = [(x, 0), (y, 1)].map(|(i, k)| texture.wrap[k].pixel(i, size[k]));
            let start = 4 * (y * picture.width + x);
            [0, 1, 2, 3].map(|k| f64::from(picture.pixels[start + k]))
        };
        if texture.nearest {
            return Some(pixel(place[0].floor(), place[1].floor()));
        }
        // Pixels have their colour at their centre.
        let [x, y] = place.map(|x| (x - 0.5).floor());
        let [s, t] = [place[0] - 0.5 - x, place[1] - 0.5 - y];
        let [a, b, c, d] = [
            pixel(x, y),
            pixel(x + 1.0, y),
            pixel(x, y + 1.0),
            pixel(x + 1.0, y + 1.0),
        ];
        Some(
            [0, 1, 2, 3].map(|k| {
                (1.0 - t) * ((1.0 - s) * a[k] + s * b[k]) + t * ((1.0 - s) * c[k] + s * d[k])
            }),
        )
    }
}

fn open<'a>(faces: &'a Faces, texture: &Texture) -> Option<&'a Picture> {
    match faces.pictures.get(texture.picture) {
        Some(Source::Open(picture)) => Some(picture),
        _ => None,
    }
}

impl Faces {
    /// Takes the looks that the file names from a material library of Wavefront (MTL): `Kd`, and `map_Kd`, before which `Kd` gives
    /// way, since programs write any grey beside it.
    pub(super) fn read_library(&mut self, text: &[u8]) {
        let mut current = None;
        for line in text.split(|&b| b == b'\n' || b == b'\r') {
            let line = line.trim_ascii();
            let key = words(line).next().unwrap_or_default();
            let rest = line[key.len()..].trim_ascii();
            match &key.to_ascii_lowercase()[..] {
                b"newmtl" => {
                    let name = String::from_utf8_lossy(rest);
                    current = self.look_names.iter().position(|known| *known == name);
                }
                b"kd" => {
                    let values: Vec<f64> =
                        words(rest).filter_map(super::super::text::number).collect();
                    if let (Some(i), &[r, g, b]) = (current, &values[..])
                        && self.looks[i].texture.is_none()
                    {
                        self.looks[i].factor = Some([r, g, b].map(|x| x.clamp(0.0, 1.0)));
                    }
                }
                b"map_kd" => {
                    if let (Some(i), Some((name, texture))) = (current, map_file(rest)) {
                        let picture = self.picture_beside(name);
                        self.looks[i].factor = None;
                        self.looks[i].texture = Some(Texture { picture, ..texture });
                    }
                }
                _ => {}
            }
        }
    }

    /// The picture in a file beside, each file once.
    pub(in crate::formats) fn picture_beside(&mut self, name: String) -> usize {
        let same = |source: &Source| matches!(source, Source::Beside(known) if *known == name);
        self.pictures.iter().position(same).unwrap_or_else(|| {
            self.pictures.push(Source::Beside(name));
            self.pictures.len() - 1
        })
    }
}

/// The name behind the options of `map_Kd`, which may have blanks and quotes, and how the picture lies.
fn map_file(rest: &[u8]) -> Option<(String, Texture)> {
    let mut rest = rest;
    let mut texture = Texture::of(0);
    while let Some(option) = words(rest).next().filter(|word| word.starts_with(b"-")) {
        // Up to three numbers.
        let numbers: Vec<f64> = words(rest)
            .skip(1)
            .take(3)
            .map_while(super::super::text::number)
            .collect();
        let values = match option {
            b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-texres" | b"-bm" | b"-boost"
            | b"-imfchan" | b"-type" => 1,
            b"-mm" => 2,
            b"-s" | b"-o" | b"-t" => numbers.len(),
            _ => break,
        };
        let moved = match option {
            b"-s" => Some(&mut texture.scale),
            b"-o" => Some(&mut texture.offset),
            _ => None,
        };
        if let Some(moved) = moved {
            moved.iter_mut().zip(&numbers).for_each(|(to, x)| *to = *x);
        }
        if option == b"-clamp" && words(rest).nth(1) == Some(b"on") {
            texture.wrap = [Wrap::Clamp; 2];
        }
        for _ in 0..=values {
            let length = words(rest).next().map_or(0, <[u8]>::len);
            rest = rest.trim_ascii_start()[length..].trim_ascii_start();
        }
    }
    let name = String::from_utf8_lossy(rest);
    let name = name.trim_matches('"');
    (!name.is_empty()).then(|| (name.into(), texture))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_go_on_beyond_their_borders() {
        let row = |wrap: Wrap| [-3.0, -1.0, 0.0, 2.0, 3.0, 5.0, 6.0].map(|i| wrap.pixel(i, 3));
        assert_eq!(row(Wrap::Repeat), [0, 2, 0, 2, 0, 2, 0]);
        assert_eq!(row(Wrap::Mirror), [2, 0, 0, 2, 2, 0, 0]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 2, 2, 2, 2]);
    }

    #[test]
    fn maps_have_options_and_names_with_blanks() {
        let name = |text: &str| {
            map_file(text.as_bytes()).map(|(name, at)| (name, at.wrap[0], at.scale, at.offset))
        };
        let plain = |name: &str| Some((name.to_string(), Wrap::Repeat, [1.0; 2], [0.0; 2]));
        assert_eq!(name("a.png"), plain("a.png"));
        assert_eq!(name("\"my scan.png\""), plain("my scan.png"));
        assert_eq!(
            name("-s 1 1 1 -clamp on  my scan.jpg"),
            Some(("my scan.jpg".into(), Wrap::Clamp, [1.0; 2], [0.0; 2]))
        );
        assert_eq!(
            name("-s 2 3 1 -o 0.5 tex/1.png"),
            Some(("tex/1.png".into(), Wrap::Repeat, [2.0, 3.0], [0.5, 0.0]))
        );
        assert_eq!(name("-bm 1"), None);
    }
}
