//! A picture of a cloud or a mesh, as `<point-weave>` shows it, made without a browser.
//!
//! 1. `camera` turns what is up upwards, and looks from the default or from where it is asked, from as far as
//!    everything is seen.
//! 2. `triangles`, or `dots`: for each sample of the picture, nine a pixel, what is nearest there.
//! 3. Of a mesh `surface` lights what is seen, once a pixel and triangle: base colour and normal out of `picture`s, or of the vertices,
//!    in the neutral `studio`. Of a cloud `dots` darkens what lies behind its neighbours.
//! 4. The samples of a pixel become its colour and coverage, and rows become a PNG file.
//!
//! **In**: a [`Scene`] in the unit frame, and [`PosterParams`]. **Out**: the bytes of a PNG file: red, green, blue, and alpha where
//! there is no background.
//!
//! **Cost**: triangles and points times the strips of the picture that they reach, and about a tenth of a microsecond a sample; 8 bytes
//! a sample of a strip.
//!
//! M. Olano, T. Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997; B. Karis, "Real shading in Unreal Engine 4",
//! 2013; C. Boucheny, "Interactive scientific visualization of large datasets", 2009, for clouds without normals; the neutral tone
//! mapper of the Khronos group.

mod camera;
mod dots;
mod picture;
mod scene;
mod strip;
mod studio;
mod surface;
mod triangles;

use crate::base::error::{Error, Result};
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::texture::picture::png;
use camera::Camera;
use glam::DVec3;
use png::ColorType;
use strip::Strip;

pub use camera::{Reach, View};
pub use scene::{Pixels, Scene};

/// Sides of a picture, in pixels.
const SIZES: [usize; 2] = [16, 4096];
/// Rows of pixels that are made at once.
const STRIP: usize = 64;

/// How it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosterParams {
    /// Width and height in pixels, 16 to 4096.
    pub size: [usize; 2],
    /// From where. Default: from the front, a little from the right and above, so that everything is seen.
    pub view: View,
    /// Which way is up, in the scene's axes. Default: y.
    pub up: DVec3,
    /// Red, green, blue behind it. Default: none, the picture has an alpha channel.
    pub background: Option<[u8; 3]>,
}

impl Default for PosterParams {
    fn default() -> Self {
        PosterParams {
            size: [800, 600],
            view: View::default(),
            up: DVec3::Y,
            background: None,
        }
    }
}

/// Draws it; the bytes of a PNG file.
///
/// # Errors
/// [`Error::EmptyCloud`]; [`Error::BadLength`], [`Error::BadIndex`]; [`Error::BadOption`] for a size or a camera out of range; [`Error::Cancelled`].
pub fn poster(
    scene: &Scene,
    params: &PosterParams,
    progress: &mut dyn Progress,
) -> Result<Vec<u8>> {
    let [width, height] = params.size;
    if !params
        .size
        .iter()
        .all(|n| (SIZES[0]..=SIZES[1]).contains(n))
    {
        let expected = "a width and a height from 16 to 4096";
        return Err(Error::bad_option(
            "size",
            expected,
            &format!("{width} x {height}"),
        ));
    }
    scene.check()?;
    let stand = camera::standing(params.up);
    let points: Vec<DVec3> = scene.points.iter().map(|p| stand * p.as_dvec3()).collect();
    let camera = Camera::new(&params.view, &points, [width, height])?;
    let drawn: Box<dyn Fn(&mut Strip) + Sync + Send> = match scene.triangles {
        Some(corners) => {
            let surface = surface::Surface::new(scene, corners, &points, stand);
            let placed = triangles::place(&points, corners, &camera);
            Box::new(move |strip| {
                triangles::draw(&placed, &camera, strip);
                strip
                    .color(|index, sample| surface.color(&placed[index as usize], sample, &camera));
            })
        }
        None => {
            let dots = dots::place(&points, &camera);
            Box::new(move |strip| dots::draw(&dots, scene.colors, strip))
        }
    };
    let strips = height.div_ceil(STRIP);
    let margin = if scene.triangles.is_some() {
        0
    } else {
        dots::MARGIN
    };
    let rows = par::map_progress(
        strips,
        20_000.0,
        (Stage::Texture, progress),
        || (),
        |i, ()| {
            let rows = i * STRIP..((i + 1) * STRIP).min(height);
            let mut strip = Strip::new(width, rows, height, margin);
            drawn(&mut strip);
            strip.pixels(params.background)
        },
    )?;
    let color = match params.background {
        Some(_) => ColorType::Rgb,
        None => ColorType::Rgba,
    };
    png(&rows.concat(), params.size, color)
}
