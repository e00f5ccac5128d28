//! What files say of where their points were seen from, in one piece and in slices.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/made.rs"]
mod made;

use glam::DVec3;
use made::Kept;
use pointweave::cloud::{Cloud, Viewpoints};
use pointweave::formats::{Format, RawCloud, Reading, read};

/// Reads the file whole and in slices, which have to say the same.
fn read_both(bytes: &[u8], format: Format) -> RawCloud {
    let cloud = read(bytes, format).unwrap();
    let mut reading = Reading::new(Some(format), None, bytes.len() as u64);
    for slice in bytes.chunks(701) {
        reading.push(slice).unwrap();
        reading.take_block();
    }
    while !reading.end().unwrap() {
        reading.take_block();
    }
    let summary = reading.summary();
    assert_eq!(
        summary.stations.viewpoints(cloud.points()),
        cloud.viewpoints
    );
    assert_eq!(
        (summary.up, summary.seen_from_above),
        (cloud.up, cloud.seen_from_above)
    );
    cloud
}

#[test]
fn e57_poses_are_viewpoints_scan_by_scan() {
    for kept in [Kept::Single, Kept::Double, Kept::Scaled] {
        // Every fifth point is invalid and left out; the first scan has no pose, the others have the same.
        let cloud = read_both(
            &made::e57(&[(kept, 10), (kept, 5), (kept, 0), (kept, 3)]),
            Format::E57,
        );
        let viewpoints = cloud.viewpoints.expect("poses");
        assert_eq!(viewpoints.positions, [DVec3::new(10.0, 20.0, 30.0)]);
        let of = viewpoints.of.expect("one scan without pose");
        assert_eq!(of[..8], [Viewpoints::UNKNOWN; 8]);
        assert_eq!(of[8..], [0; 7]);
    }
}

#[test]
fn an_e57_without_poses_knows_nothing_unless_it_is_spherical() {
    for kept in [Kept::Single, Kept::Double, Kept::Scaled] {
        assert_eq!(
            read_both(&made::e57(&[(kept, 10)]), Format::E57).viewpoints,
            None
        );
    }
    let cloud = read_both(&made::e57(&[(Kept::Spherical, 10)]), Format::E57);
    let origin = Viewpoints {
        positions: vec![DVec3::ZERO],
        of: None,
    };
    assert_eq!(cloud.viewpoints, Some(origin));
    let cloud = read_both(
        &made::e57(&[(Kept::Spherical, 2), (Kept::Spherical, 1)]),
        Format::E57,
    );
    let viewpoints = cloud.viewpoints.unwrap();
    assert_eq!(
        viewpoints.positions,
        [DVec3::ZERO, DVec3::new(10.0, 20.0, 30.0)]
    );
    assert_eq!(viewpoints.of, Some(vec![0, 0, 1]));
}

#[test]
fn an_e57_pose_that_is_none_says_nothing() {
    let pose = |w: f64, x: f64, place: [f64; 3]| made::pose([w, x, 0.0, 0.0], place);
    for bad in [
        pose(1.0, 0.0, [0.0; 3]),
        pose(0.0, 0.0, [1.0, 2.0, 3.0]),
        pose(0.5, 0.0, [1.0, 2.0, 3.0]),
        pose(1.0, 0.0, [f64::INFINITY, 2.0, 3.0]),
    ] {
        let file = made::e57_at(&[(Kept::Double, 10, Some(bad.clone()))]);
        assert_eq!(read_both(&file, Format::E57).viewpoints, None, "{bad:?}");
    }
    for (good, place) in [
        (pose(1.0, 0.0, [1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]),
        (pose(0.6, 0.8, [0.0; 3]), [0.0; 3]),
    ] {
        let file = made::e57_at(&[(Kept::Double, 10, Some(good))]);
        let viewpoints = read_both(&file, Format::E57).viewpoints.expect("a pose");
        assert_eq!(viewpoints.positions, [DVec3::from(place)]);
        assert_eq!(viewpoints.of, None);
    }
}

/// A PCD of `width` times `height` points, text, with this line for the viewpoint.
fn pcd(
    viewpoint: &str,
    width: usize,
    height: usize,
    point: impl Fn(usize, usize) -> [f64; 3],
) -> Vec<u8> {
    let mut file = format!(
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {width}\nHEIGHT {height}\n{viewpoint}POINTS {}\nDATA ascii\n",
        width * height
    );
    for row in 0..height {
        for column in 0..width {
            let [x, y, z] = point(row, column);
            file += &format!("{x} {y} {z}\n");
        }
    }
    file.into_bytes()
}

/// The only viewpoint, which saw all.
fn only(cloud: &RawCloud) -> Option<[f64; 3]> {
    let Viewpoints { positions, of } = cloud.viewpoints.as_ref()?;
    assert_eq!((positions.len(), of), (1, &None));
    Some(positions[0].to_array())
}

#[test]
fn a_pcd_viewpoint_counts_unless_it_is_the_default() {
    let line = |_: usize, column: usize| [column as f64, 0.5, 1.0];
    for (said, expected) in [
        ("VIEWPOINT 1 -2.5 3e2 1 0 0 0\n", Some([1.0, -2.5, 300.0])),
        ("VIEWPOINT 0 0 0.25\n", Some([0.0, 0.0, 0.25])),
        ("VIEWPOINT 0 0 0 1 0 0 0\n", None),
        ("VIEWPOINT 0 0 0 0.6 0.8 0 0\n", None),
        ("VIEWPOINT nan 1 2 1 0 0 0\n", None),
        ("VIEWPOINT 1 2\n", None),
        ("VIEWPOINT\n", None),
        ("", None),
    ] {
        let cloud = read_both(&pcd(said, 9, 1, line), Format::Pcd);
        assert_eq!(only(&cloud), expected, "{said}");
    }
}

/// What a camera sees in its own frame: a wall with a step, every seventh pixel empty.
fn pixel(row: usize, column: usize) -> [f64; 3] {
    let (u, v) = (column as f64 - 19.5, row as f64 - 14.5);
    let depth = match (row * 40 + column) % 7 {
        0 => f64::NAN,
        _ if column > 25 => 1.4 + 0.01 * v,
        _ => 2.0 + 0.02 * u,
    };
    [u / 32.0 * depth, v / 32.0 * depth, depth]
}

#[test]
fn an_organised_pcd_is_seen_from_the_origin_where_it_is_a_picture_taken_there() {
    let origin = Some([0.0; 3]);
    assert_eq!(
        only(&read_both(&pcd("", 40, 30, pixel), Format::Pcd)),
        origin
    );
    let said = "VIEWPOINT 0 0 0 1 0 0 0\n";
    assert_eq!(
        only(&read_both(&pcd(said, 40, 30, pixel), Format::Pcd)),
        origin
    );
    // Rings of a scanner that turns, rows of azimuth.
    let ring = |row: usize, column: usize| {
        let (azimuth, elevation) = (column as f64 * 0.1, (row as f64 - 8.0) * 0.03);
        let range = if column % 9 < 4 { 4.0 } else { 7.0 };
        [
            azimuth.cos() * elevation.cos(),
            azimuth.sin() * elevation.cos(),
            elevation.sin(),
        ]
        .map(|x| x * range)
    };
    assert_eq!(
        only(&read_both(&pcd("", 62, 16, ring), Format::Pcd)),
        origin
    );
    // A viewpoint that is said counts, whatever the picture is.
    let moved = "VIEWPOINT 0 0 0.1 1 0 0 0\n";
    assert_eq!(
        only(&read_both(&pcd(moved, 40, 30, pixel), Format::Pcd)),
        Some([0.0, 0.0, 0.1])
    );

    // The same picture in the frame of the room; a grid of heights over the origin, one beside it, one far away; too few pixels.
    let turned = |row, column| {
        let [x, y, z] = pixel(row, column);
        [x, z - 1.5, 0.2 - y]
    };
    let heights = |low: f64, base: f64| {
        move |row: usize, column: usize| {
            let (x, y) = (low + 0.25 * column as f64, low + 0.25 * row as f64);
            [x, y, base + 0.4 * (1.5 * x).sin() * (1.2 * y).cos()]
        }
    };
    let beside = heights(3.0, 0.0);
    for (what, file) in [
        ("turned", pcd("", 40, 30, turned)),
        ("over the origin", pcd("", 40, 30, heights(-5.0, 1.0))),
        ("beside the origin", pcd("", 40, 30, beside)),
        ("far away", pcd("", 40, 30, heights(500_000.0, 200.0))),
        (
            "few",
            pcd("", 8, 8, |row, column| pixel(row + 8, column + 8)),
        ),
        (
            "one row",
            pcd("", 1200, 1, |_, column| pixel(column / 40, column % 40)),
        ),
        (
            "flat at the origin",
            pcd("", 40, 30, |row, column| [column as f64, row as f64, 0.0]),
        ),
    ] {
        assert_eq!(only(&read_both(&file, Format::Pcd)), None, "{what}");
    }
}

#[test]
fn las_and_laz_are_seen_from_above_and_nothing_else_is() {
    for packed in [false, true] {
        let cloud = read_both(&made::las(0, 20, (1, 2), packed), Format::Las);
        assert!(cloud.seen_from_above);
        assert_eq!((cloud.up, cloud.viewpoints), (Some([0.0, 0.0, 1.0]), None));
    }
    let cloud = read_both(b"0 0 1\n2 3 4\n5 6 7\n", Format::Xyz);
    assert!(!cloud.seen_from_above);
    assert_eq!(cloud.viewpoints, None);
}

#[test]
fn what_a_file_says_reaches_the_cloud() {
    let file = made::e57(&[(Kept::Double, 10), (Kept::Double, 5)]);
    let raw = read(&file, Format::E57).unwrap();
    assert_eq!(raw.to_cloud().unwrap().viewpoints, raw.viewpoints);
    let cloud = read(&made::las(0, 20, (1, 2), false), Format::Las)
        .unwrap()
        .to_cloud()
        .unwrap();
    assert!(cloud.seen_from_above);
    assert_eq!(cloud.up, Some(glam::Vec3::Z));
    // And back, for a writer.
    let again = RawCloud::of_cloud(&cloud);
    assert!(again.seen_from_above);
    assert_eq!(again.up, Some([0.0, 0.0, 1.0]));
}

#[test]
fn a_normal_that_is_zero_or_not_finite_is_none() {
    let cloud = || Cloud::from_f32(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).unwrap();
    let normals = [0.0, 0.0, 2.0, f32::NAN, 1.0, 0.0, 0.0, 0.0, 0.0];
    let expected = vec![glam::Vec3::Z, glam::Vec3::ZERO, glam::Vec3::ZERO];
    assert_eq!(
        cloud().with_normals(&normals).unwrap().normals,
        Some(expected)
    );
    for none in [0.0, f32::NAN, f32::INFINITY] {
        assert_eq!(
            cloud().with_normals(&[none; 9]).unwrap().normals,
            None,
            "{none}"
        );
    }
    assert_eq!(
        cloud().with_normals(&[1.0; 6]).unwrap_err().code(),
        "bad-length"
    );
}

#[test]
fn a_selection_keeps_what_is_known_of_its_points() {
    let positions: Vec<f64> = (0..30).map(f64::from).collect();
    let views = [0.0, 0.0, 9.0, 5.0, 5.0, 5.0];
    let of = [0, 1, Viewpoints::UNKNOWN, 1, 0, 0, 1, 1, 0, 0];
    let cloud = Cloud::from_f64(&positions).unwrap();
    let cloud = cloud.with_viewpoints(&views, Some(&of)).unwrap();
    let cloud = cloud
        .with_up([0.0, 0.0, 3.0])
        .unwrap()
        .with_seen_from_above(true);
    let some = cloud.select(&[1, 2, 4]).unwrap();
    let viewpoints = some.viewpoints.unwrap();
    assert_eq!(viewpoints.of, Some(vec![1, Viewpoints::UNKNOWN, 0]));
    assert_eq!(viewpoints.positions.len(), 2);
    assert_eq!((some.up, some.seen_from_above), (Some(glam::Vec3::Z), true));
}
