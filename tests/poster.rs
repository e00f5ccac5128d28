//! Posters: where things are in the picture, which of them is in front, and which colour they have.

use glam::{DVec3, Vec3};
use pointweave::Error;
use pointweave::poster::{Pixels, PosterParams, Reach, Scene, View, poster};
use pointweave::progress::Silent;

/// Straight at the front, from where everything is seen.
const FRONT: View = View {
    azimuth: Some(0.0),
    polar: Some(90.0),
    reach: Reach::Share(1.0),
};

fn params(view: View) -> PosterParams {
    PosterParams {
        size: [120, 90],
        view,
        ..PosterParams::default()
    }
}

/// Red, green, blue and alpha of each pixel, row after row.
fn drawn(scene: &Scene, params: &PosterParams) -> Vec<[u8; 4]> {
    let file = poster(scene, params, &mut Silent).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!([info.width as usize, info.height as usize], params.size);
    match info.color_type {
        png::ColorType::Rgba => bytes.as_chunks().0.to_vec(),
        _ => bytes
            .chunks_exact(3)
            .map(|c| [c[0], c[1], c[2], 255])
            .collect(),
    }
}

/// An upright square of the unit frame, `z` towards who looks, and its triangles, out to the front.
fn square(z: f32) -> (Vec<Vec3>, [[u32; 3]; 2]) {
    let half = 0.5 / 2f32.sqrt();
    let corner = |(x, y)| Vec3::new(x, y, z);
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    (corners.map(corner).to_vec(), [[0, 1, 2], [0, 2, 3]])
}

#[test]
fn a_square_from_the_front_has_its_place_and_its_coverage() {
    let (points, triangles) = square(0.0);
    let scene = Scene {
        points: &points,
        triangles: Some(&triangles),
        ..Scene::default()
    };
    let picture = drawn(&scene, &params(FRONT));
    // As high as 1 / 1.1 of the picture's 90 rows.
    let side = 90.0 / 1.1;
    let covered: f64 = picture.iter().map(|p| f64::from(p[3]) / 255.0).sum();
    assert!((covered / (side * side) - 1.0).abs() < 0.01, "{covered}");
    assert_eq!(
        [picture[45 * 120 + 60][3], picture[45 * 120 + 2][3]],
        [255, 0]
    );
    // White in the light: no colour, and bright.
    let [r, g, b, _] = picture[45 * 120 + 60];
    assert!(r == g && g == b && r > 180, "{r} {g} {b}");
    // From half as far it is twice as high: it fills the picture.
    let near = View {
        reach: Reach::Share(0.5),
        ..FRONT
    };
    assert!(drawn(&scene, &params(near)).iter().all(|p| p[3] == 255));
    // From behind it is there, too, as large.
    let behind = View {
        azimuth: Some(180.0),
        ..FRONT
    };
    let back: f64 = drawn(&scene, &params(behind))
        .iter()
        .map(|p| f64::from(p[3]) / 255.0)
        .sum();
    assert!((back - covered).abs() < 1.0, "{back} {covered}");
}

#[test]
fn what_is_nearer_is_in_front_and_up_is_up() {
    let ((mut points, first), (more, _)) = (square(0.3), square(-0.3));
    points.extend(more);
    let triangles = [first[0], first[1], [4, 5, 6], [4, 6, 7]];
    let colors: Vec<[u8; 3]> = (0..8)
        .map(|v| if v < 4 { [200, 0, 0] } else { [0, 0, 200] })
        .collect();
    let scene = Scene {
        points: &points,
        triangles: Some(&triangles),
        colors: Some(&colors),
        ..Scene::default()
    };
    let middle = |azimuth: f64| {
        let view = View {
            azimuth: Some(azimuth),
            ..FRONT
        };
        drawn(&scene, &params(view))[45 * 120 + 60]
    };
    let ([red, _, none, _], [nothing, _, blue, _]) = (middle(0.0), middle(180.0));
    assert!(
        red > 120 && none < 90 && blue > 120 && nothing < 90,
        "{red} {none} {blue} {nothing}"
    );
    // What stands along z is as a picture what stands along y.
    let turned: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.x, -p.z, p.y)).collect();
    let lying = Scene {
        points: &turned,
        ..scene
    };
    let up = PosterParams {
        up: DVec3::Z,
        ..params(View::default())
    };
    assert_eq!(drawn(&lying, &up), drawn(&scene, &params(View::default())));
}

#[test]
fn pictures_lie_where_their_places_say() {
    let (points, triangles) = square(0.0);
    // Red and green above, blue and white below.
    let rgba = [
        [255, 0, 0, 255],
        [0, 255, 0, 255],
        [0, 0, 255, 255],
        [255; 4],
    ];
    let color = Pixels {
        width: 2,
        rgba: rgba.as_flattened(),
    };
    let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let scene = Scene {
        points: &points,
        triangles: Some(&triangles),
        uvs: Some(&uvs),
        color: Some(color),
        ..Scene::default()
    };
    let picture = drawn(&scene, &params(FRONT));
    let brightest = |x: usize, y: usize| {
        let [r, g, b, _] = picture[y * 120 + x].map(i32::from);
        [
            r > g + 60 && r > b + 60,
            g > r + 60 && g > b + 60,
            b > r + 60 && b > g + 60,
        ]
    };
    assert_eq!(brightest(25, 10), [true, false, false]);
    assert_eq!(brightest(95, 10), [false, true, false]);
    assert_eq!(brightest(25, 80), [false, false, true]);
    assert_eq!(brightest(95, 80), [false, false, false]);
}

#[test]
fn where_less_light_comes_to_it_is_darker() {
    let (points, triangles) = square(0.0);
    let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let lit = |open: u8| {
        let rgba = [open, 0, 0, 255];
        let occlusion = Pixels {
            width: 1,
            rgba: &rgba,
        };
        let scene = Scene {
            points: &points,
            triangles: Some(&triangles),
            uvs: Some(&uvs),
            occlusion: Some(occlusion),
            ..Scene::default()
        };
        drawn(&scene, &params(FRONT))[45 * 120 + 60]
    };
    let bare = Scene {
        points: &points,
        triangles: Some(&triangles),
        ..Scene::default()
    };
    assert_eq!(lit(255), drawn(&bare, &params(FRONT))[45 * 120 + 60]);
    assert!(lit(128)[0] < lit(255)[0] - 30);
    assert_eq!(lit(0), [0, 0, 0, 255]);
}

#[test]
fn points_are_dots_of_their_colour_and_darker_behind_an_edge() {
    let grid = |k: usize| {
        Vec3::new(
            (k % 60) as f32 / 59.0 - 0.5,
            (k / 60) as f32 / 59.0 - 0.5,
            0.0,
        ) * 0.7
    };
    let mut points: Vec<Vec3> = (0..3600).map(grid).collect();
    points.extend((0..3600).map(|k| grid(k) * 0.3 + Vec3::new(0.0, 0.0, 0.3)));
    let colors = vec![[90, 120, 60]; points.len()];
    let scene = Scene {
        points: &points,
        colors: Some(&colors),
        ..Scene::default()
    };
    let picture = drawn(&scene, &params(FRONT));
    let row = &picture[45 * 120..46 * 120];
    assert_eq!(row[60], [90, 120, 60, 255]);
    let darkest = row
        .iter()
        .filter(|p| p[3] == 255)
        .map(|p| p[1])
        .min()
        .unwrap();
    assert!(darkest < 105, "{darkest}");
    let behind = PosterParams {
        background: Some([1, 2, 3]),
        ..params(FRONT)
    };
    assert_eq!(drawn(&scene, &behind)[0], [1, 2, 3, 255]);
}

#[test]
fn a_camera_within_things_draws_and_what_is_wrong_has_its_error() {
    let (points, triangles) = square(0.2);
    let scene = Scene {
        points: &points,
        triangles: Some(&triangles),
        ..Scene::default()
    };
    let inside = View {
        azimuth: Some(77.0),
        polar: Some(80.0),
        reach: Reach::Length(0.02),
    };
    drawn(&scene, &params(inside));
    let code = |scene: &Scene, params: &PosterParams| {
        poster(scene, params, &mut Silent).unwrap_err().code()
    };
    let fine = params(FRONT);
    assert_eq!(code(&Scene::default(), &fine), "empty-cloud");
    assert_eq!(
        code(
            &scene,
            &PosterParams {
                size: [8, 90],
                ..fine
            }
        ),
        "bad-option"
    );
    let nowhere = View {
        reach: Reach::Share(f64::NAN),
        ..FRONT
    };
    assert_eq!(code(&scene, &params(nowhere)), "bad-option");
    let wrong = [[0, 1, 9]];
    let found = poster(
        &Scene {
            triangles: Some(&wrong),
            ..scene
        },
        &fine,
        &mut Silent,
    )
    .unwrap_err();
    assert!(
        matches!(
            found,
            Error::BadIndex {
                index: 2,
                points: 4,
                found: 9
            }
        ),
        "{found}"
    );
    assert_eq!(
        code(
            &Scene {
                uvs: Some(&[[0.0; 2]]),
                ..scene
            },
            &fine
        ),
        "bad-length"
    );
    for (width, bytes) in [(0, 4), (2, 12), (1, 0)] {
        let rgba = vec![0; bytes];
        let color = Some(Pixels { width, rgba: &rgba });
        assert_eq!(code(&Scene { color, ..scene }, &fine), "bad-length");
    }
}
