//! Pictures on light meshes: where charts are, and what the pictures show.

use glam::{DVec2, DVec3};
use pointweave::pipeline::texture;
use pointweave::progress::Silent;
use pointweave::texture::{Map, Paint, Texture, TextureParams, Textured};
use pointweave::{Cloud, Error};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A hilly grid of `n` by `n` cells over the unit square: positions and triangles.
fn hills(n: usize) -> (Vec<f64>, Vec<u32>) {
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    let place =
        |k: usize| height([k / (n + 1), k % (n + 1)].map(|i| i as f64 / n as f64)).to_array();
    let cell = |k: usize| {
        let (i, j) = (k / n, k % n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [a, b, c, a, c, d]
    };
    let positions = (0..(n + 1) * (n + 1)).flat_map(place).collect();
    (positions, (0..n * n).flat_map(cell).collect())
}

fn height([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x, y, 0.04 * (20.0 * x).sin() * (17.0 * y).cos())
}

fn slope([x, y]: [f64; 2]) -> DVec3 {
    let by_x = 0.8 * (20.0 * x).cos() * (17.0 * y).cos();
    let by_y = -0.68 * (20.0 * x).sin() * (17.0 * y).sin();
    DVec3::new(-by_x, -by_y, 1.0).normalize()
}

fn color(p: DVec3) -> DVec3 {
    127.5
        + 120.0
            * DVec3::new(
                (9.0 * p.x).sin(),
                (9.0 * p.y).cos(),
                (7.0 * (p.x + p.y)).sin(),
            )
}

/// The hills by 250 triangles, with what 20,000 show.
fn textured(size: usize) -> (Cloud, Textured) {
    let (positions, indices) = hills(100);
    let cloud = Cloud::from_f64(&positions).unwrap();
    let colors: Vec<[u8; 3]> = positions
        .chunks_exact(3)
        .map(|p| {
            color(DVec3::from_slice(p))
                .to_array()
                .map(|x| x.round() as u8)
        })
        .collect();
    let params = TextureParams {
        size: Some(size),
        ..Default::default()
    };
    let scan = (&positions[..], Paint::Colors(&colors));
    let (textured, report) =
        texture((&cloud, &indices), scan, Some(250), &params, &mut Silent).unwrap();
    assert!(report.unwrap().triangles <= 250);
    (cloud, textured)
}

/// Pixels of a PNG file.
fn pixels(texture: &Texture) -> Vec<[u8; 3]> {
    let decoder = png::Decoder::new(std::io::Cursor::new(&texture.png));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(
        (info.width as usize, info.height as usize),
        (texture.width, texture.height)
    );
    match info.color_type {
        png::ColorType::Grayscale => bytes.iter().map(|&x| [x; 3]).collect(),
        _ => bytes.as_chunks().0.to_vec(),
    }
}

/// Between texels, as a renderer reads it.
fn sample(pixels: &[[u8; 3]], texture: &Texture, [u, v]: [f64; 2]) -> DVec3 {
    let at = DVec2::new(u * texture.width as f64, v * texture.height as f64) - 0.5;
    let low = at.floor();
    let part = at - low;
    let texel = |dx: f64, dy: f64| {
        let x = (low.x + dx).clamp(0.0, texture.width as f64 - 1.0) as usize;
        let y = (low.y + dy).clamp(0.0, texture.height as f64 - 1.0) as usize;
        DVec3::from(pixels[y * texture.width + x].map(f64::from))
    };
    texel(0.0, 0.0)
        .lerp(texel(1.0, 0.0), part.x)
        .lerp(texel(0.0, 1.0).lerp(texel(1.0, 1.0), part.x), part.y)
}

/// `look` at places of every triangle: which one, and how much its corners count.
fn everywhere(t: &Textured, mut look: impl FnMut([u32; 3], [f64; 3])) {
    for &triangle in &t.painted.mesh.triangles {
        for i in 0..=6 {
            for j in 0..=(6 - i) {
                look(
                    triangle,
                    [i as f64 / 6.0, j as f64 / 6.0, (6 - i - j) as f64 / 6.0],
                );
            }
        }
    }
}

fn mix(triangle: [u32; 3], weights: [f64; 3], value: impl Fn(usize) -> DVec3) -> DVec3 {
    (0..3)
        .map(|k| value(triangle[k] as usize) * weights[k])
        .sum()
}

#[test]
fn colours_and_normals_are_those_of_the_full_mesh() {
    let (cloud, t) = textured(256);
    let mesh = &t.painted.mesh;
    let [colors, normals] = [&t.textures[0], &t.textures[1]];
    assert_eq!([colors.map, normals.map], [Map::Color, Map::Normal]);
    let [color_pixels, normal_pixels] = [pixels(colors), pixels(normals)];
    let (mut off, mut turned, mut flat, mut count) = (0.0, 0.0, 0.0, 0.0);
    everywhere(&t, |triangle, weights| {
        let uv = mix(triangle, weights, |v| {
            DVec3::new(t.uvs[v][0].into(), t.uvs[v][1].into(), 0.0)
        });
        let uv = [uv.x, uv.y];
        let at = mix(triangle, weights, |v| {
            DVec3::from(cloud.frame.to_caller(mesh.vertices[v]))
        });
        off += sample(&color_pixels, colors, uv).distance_squared(color(at)) / 3.0;
        // The frame as three.js makes it.
        let out = mix(triangle, weights, |v| mesh.normals[v].as_dvec3()).normalize();
        let tangent = mix(triangle, weights, |v| {
            DVec3::new(
                t.tangents[v][0].into(),
                t.tangents[v][1].into(),
                t.tangents[v][2].into(),
            )
        })
        .normalize();
        let bitangent =
            (out.cross(tangent) * f64::from(t.tangents[triangle[0] as usize][3])).normalize();
        let told = sample(&normal_pixels, normals, uv) / 127.5 - 1.0;
        let normal = (tangent * told.x + bitangent * told.y + out * told.z).normalize();
        let truth = slope([at.x, at.y]);
        turned += normal.angle_between(truth).to_degrees();
        flat += out.angle_between(truth).to_degrees();
        count += 1.0;
    });
    let (off, turned, flat) = ((off / count).sqrt(), turned / count, flat / count);
    assert!(off < 4.0, "{off} of 255");
    assert!(
        turned < 2.5 && turned < 0.5 * flat,
        "{turned}° with the map, {flat}° without"
    );
}

/// Where two triangles of the mesh have the centre of one texel, and whether one has none, are rasterised here.
#[test]
fn no_two_triangles_are_at_one_place_and_each_has_its_texels() {
    let (_, t) = textured(512);
    let [width, height] = [t.textures[0].width, t.textures[0].height];
    let mut owners = vec![0u8; width * height];
    let corner = |v: u32| {
        DVec2::new(
            f64::from(t.uvs[v as usize][0]) * width as f64,
            f64::from(t.uvs[v as usize][1]) * height as f64,
        )
    };
    for &triangle in &t.painted.mesh.triangles {
        let [a, b, c] = triangle.map(corner);
        let twice = (b - a).perp_dot(c - a);
        assert!(twice > 2.0, "a triangle covers {} texels", twice / 2.0);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            if [(a, b), (b, c), (c, a)]
                .iter()
                .all(|&(q, r)| (r - q).perp_dot(p - q) > 1e-3)
            {
                owners[y * width + x] += 1;
            }
        }
    }
    assert_eq!(owners.iter().filter(|&&n| n > 1).count(), 0);
}

#[test]
fn frames_are_upright_and_of_unit_length() {
    let (_, t) = textured(128);
    assert_eq!(t.tangents.len(), t.painted.mesh.vertices.len());
    for (&[x, y, z, w], normal) in t.tangents.iter().zip(&t.painted.mesh.normals) {
        let tangent = DVec3::new(x.into(), y.into(), z.into());
        assert!((tangent.length() - 1.0).abs() < 1e-5 && w.abs() == 1.0);
        assert!(tangent.dot(normal.as_dvec3()).abs() < 0.02);
    }
}

/// A wall of two sides, red and blue, thinner than its points are apart.
#[test]
fn colours_do_not_come_through_a_thin_wall() {
    let n = 24;
    let mut positions = Vec::new();
    let mut indices: Vec<u32> = Vec::new();
    for (side, z) in [(0u32, 0.0), (1, 0.02)] {
        let at = |i: usize, j: usize| side * ((n + 1) * (n + 1)) as u32 + (i * (n + 1) + j) as u32;
        for i in 0..=n {
            for j in 0..=n {
                positions.extend([i as f64 / n as f64, j as f64 / n as f64, z]);
            }
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            indices.extend(if side == 1 {
                [a, b, c, a, c, d]
            } else {
                [a, c, b, a, d, c]
            });
        }
    }
    let colors: Vec<[u8; 3]> = positions
        .chunks_exact(3)
        .map(|p| {
            if p[2] > 0.01 {
                [255, 0, 0]
            } else {
                [0, 0, 255]
            }
        })
        .collect();
    let cloud = Cloud::from_f64(&positions).unwrap();
    let params = TextureParams {
        size: Some(128),
        maps: vec![Map::Color],
    };
    let (t, _) = texture(
        (&cloud, &indices),
        (&positions, Paint::Colors(&colors)),
        None,
        &params,
        &mut Silent,
    )
    .unwrap();
    let shown = pixels(&t.textures[0]);
    everywhere(&t, |triangle, weights| {
        let uv = mix(triangle, weights, |v| {
            DVec3::new(t.uvs[v][0].into(), t.uvs[v][1].into(), 0.0)
        });
        let z = mix(triangle, weights, |v| {
            DVec3::from(cloud.frame.to_caller(t.painted.mesh.vertices[v]))
        })
        .z;
        let expected = if z > 0.01 { DVec3::X } else { DVec3::Z } * 255.0;
        assert_eq!(sample(&shown, &t.textures[0], [uv.x, uv.y]), expected);
    });
}

#[test]
fn without_colours_there_is_no_picture_of_them_and_a_wrong_size_is_an_error() {
    let (positions, indices) = hills(8);
    let cloud = Cloud::from_f64(&positions).unwrap();
    let bake = |size| {
        let params = TextureParams {
            size,
            ..Default::default()
        };
        texture(
            (&cloud, &indices),
            (&positions, Paint::Nothing),
            None,
            &params,
            &mut Silent,
        )
    };
    let (t, report) = bake(None).unwrap();
    assert_eq!(
        t.textures.iter().map(|t| t.map).collect::<Vec<_>>(),
        [Map::Normal]
    );
    assert!(t.textures[0].width == 256 && report.is_none());
    for size in [63, 8193] {
        assert!(matches!(bake(Some(size)), Err(Error::BadOption { .. })));
    }
}

/// A floor with a wall on its side at x = 0, `high` as the floor is wide, each of `n` by `n` cells.
fn corner(n: usize, high: f64) -> (Vec<f64>, Vec<u32>) {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for wall in [false, true] {
        let first = (positions.len() / 3) as u32;
        for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
            let [s, t] = [i, j].map(|k| k as f64 / n as f64);
            positions.extend(if wall {
                [0.0, t, s * high]
            } else {
                [s, t, 0.0]
            });
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let at = |i: usize, j: usize| first + (i * (n + 1) + j) as u32;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            indices.extend(if wall {
                [a, c, b, a, d, c]
            } else {
                [a, b, c, a, c, d]
            });
        }
    }
    (positions, indices)
}

/// How open the floor is `x` beside the middle of a wall from y = 0 to 1: the mean over directions, weighted by the cosine, of how far it
/// is to the wall, of `reach` at most.
fn open_beside_a_wall([x, y]: [f64; 2], high: f64, reach: f64) -> f64 {
    const STEPS: usize = 300;
    let (mut open, mut all) = (0.0, 0.0);
    for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
        // Evenly by cosine over the half sphere: the disk below it.
        let radius = ((i as f64 + 0.5) / STEPS as f64).sqrt();
        let turn = std::f64::consts::TAU * (j as f64 + 0.5) / STEPS as f64;
        let d = DVec3::new(
            radius * turn.cos(),
            radius * turn.sin(),
            (1.0 - radius * radius).sqrt(),
        );
        let free = if d.x < 0.0 { x / -d.x } else { f64::INFINITY };
        let hits = free * d.z < high && (0.0..1.0).contains(&(y + free * d.y));
        open += if hits { (free / reach).min(1.0) } else { 1.0 };
        all += 1.0;
    }
    open / all
}

#[test]
fn occlusion_beside_a_wall_is_that_of_the_half_space() {
    let high = 0.5;
    let (positions, indices) = corner(40, high);
    let cloud = Cloud::from_f64(&positions).unwrap();
    let params = TextureParams {
        size: Some(512),
        maps: vec![Map::Occlusion],
    };
    let (t, _) = texture(
        (&cloud, &indices),
        (&positions, Paint::Nothing),
        None,
        &params,
        &mut Silent,
    )
    .unwrap();
    let [texture] = &t.textures[..] else {
        panic!("{} pictures", t.textures.len());
    };
    let (shown, reach) = (pixels(texture), 0.25 * cloud.frame.diagonal);
    let (mut squares, mut count, mut worst) = (0.0, 0.0, 0.0f64);
    for &triangle in &t.painted.mesh.triangles {
        let middle = |value: &dyn Fn(usize) -> DVec3| mix(triangle, [1.0 / 3.0; 3], value);
        let at = middle(&|v| DVec3::from(cloud.frame.to_caller(t.painted.mesh.vertices[v])));
        let uv = middle(&|v| DVec3::new(t.uvs[v][0].into(), t.uvs[v][1].into(), 0.0));
        if at.z.abs() > 1e-4 || at.x < 0.05 {
            continue;
        }
        let told = sample(&shown, texture, [uv.x, uv.y]).x / 255.0;
        let off = told - open_beside_a_wall([at.x, at.y], high, reach);
        squares += off * off;
        count += 1.0;
        worst = worst.max(off.abs());
    }
    let rms = f64::sqrt(squares / count);
    assert!(count > 2000.0, "{count} places");
    assert!(rms < 0.01 && worst < 0.05, "{rms} (rms), {worst} at most");
}

#[test]
fn a_flat_box_is_open_outside_and_dark_inside() {
    // Its corners have the mean normals of three faces.
    let corners: Vec<f64> = (0..8)
        .flat_map(|k| [(k & 1) as f64, (k >> 1 & 1) as f64, 0.1 * (k >> 2) as f64])
        .collect();
    let faces: [[u32; 4]; 6] = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    for inwards in [false, true] {
        let corner = |k: u32| corners[3 * k as usize..][..3].to_vec();
        let positions: Vec<f64> = faces.iter().flatten().flat_map(|&k| corner(k)).collect();
        let indices: Vec<u32> = (0..6)
            .flat_map(|f| {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| 4 * f + k);
                match inwards {
                    true => [a, c, b, a, d, c],
                    false => [a, b, c, a, c, d],
                }
            })
            .collect();
        let cloud = Cloud::from_f64(&positions).unwrap();
        let params = TextureParams {
            size: Some(128),
            maps: vec![Map::Occlusion],
        };
        let scan = (&positions[..], Paint::Nothing);
        let (t, _) = texture((&cloud, &indices), scan, None, &params, &mut Silent).unwrap();
        let shown = pixels(&t.textures[0]);
        let (mut sum, mut count) = (0.0, 0.0);
        everywhere(&t, |triangle, weights| {
            let uv = mix(triangle, weights, |v| {
                DVec3::new(t.uvs[v][0].into(), t.uvs[v][1].into(), 0.0)
            });
            sum += sample(&shown, &t.textures[0], [uv.x, uv.y]).x;
            count += 1.0;
        });
        let mean = sum / count;
        let range = if inwards { 80.0..160.0 } else { 250.0..255.1 };
        assert!(range.contains(&mean), "{mean}, inwards: {inwards}");
    }
}

#[test]
fn values_become_colours_of_a_ramp_and_those_that_are_none_show_nothing() {
    let (positions, indices) = hills(40);
    let cloud = Cloud::from_f64(&positions).unwrap();
    let ramp: Vec<[u8; 3]> = (0..=255).map(|k| [k, 255 - k, 7]).collect();
    // As x, but beyond the ends, and unknown in a strip.
    let value = |p: &[f64]| match p[1] {
        y if (0.4..0.45).contains(&y) => f32::NAN,
        _ => 1.5 * p[0] as f32 - 0.25,
    };
    let values: Vec<f32> = positions.chunks_exact(3).map(value).collect();
    let params = TextureParams {
        size: Some(256),
        maps: vec![Map::Color],
    };
    let baked = |values: &[f32], ramp: &[[u8; 3]]| {
        let paint = Paint::Scalars { values, ramp };
        let scan = (&positions[..], paint);
        texture((&cloud, &indices), scan, Some(500), &params, &mut Silent)
    };
    let (t, _) = baked(&values, &ramp).unwrap();
    let shown = pixels(&t.textures[0]);
    assert!(shown.iter().all(|&[r, g, b]| r == 255 - g && b == 7));
    let (mut squares, mut count) = (0.0, 0.0);
    everywhere(&t, |triangle, weights| {
        let uv = mix(triangle, weights, |v| {
            DVec3::new(t.uvs[v][0].into(), t.uvs[v][1].into(), 0.0)
        });
        let at = mix(triangle, weights, |v| {
            DVec3::from(cloud.frame.to_caller(t.painted.mesh.vertices[v]))
        });
        let told = sample(&shown, &t.textures[0], [uv.x, uv.y]).x / 255.0;
        squares += (told - (1.5 * at.x - 0.25).clamp(0.0, 1.0)).powi(2);
        count += 1.0;
    });
    let rms = f64::sqrt(squares / count);
    assert!(rms < 0.015, "{rms}");
    assert_eq!(baked(&values[1..], &ramp).unwrap_err().code(), "bad-length");
    assert_eq!(baked(&values, &[]).unwrap_err().code(), "bad-option");
}

#[test]
fn sides_of_pictures_are_whole_blocks() {
    let (_, t) = textured(257);
    for Texture { width, height, .. } in &t.textures {
        assert_eq!([width % 4, height % 4], [0, 0], "{width} x {height}");
    }
}
