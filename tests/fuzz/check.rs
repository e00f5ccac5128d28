//! What holds of any bytes: a reader gives a cloud that fits together, or a typed error; and the same in slices.

use pointweave::formats::{FaceMode, Format, Positions, RawCloud, ReadOptions, Reading, read};

pub fn check(bytes: &[u8], formats: &[Format]) {
    for &format in formats {
        let whole = read(bytes, format);
        if let Ok(cloud) = &whole {
            check_cloud(cloud);
        }
        // Slices of a size that the content decides.
        let size = 1 + bytes
            .iter()
            .take(64)
            .map(|&b| usize::from(b))
            .sum::<usize>()
            % 700;
        let sliced = read_slices(bytes, size, format);
        assert_eq!(
            sliced,
            whole.map(|cloud| {
                // What only the end tells is in the slices still.
                let skipped = cloud.skipped.iter();
                let later = skipped.filter(|(why, _)| ["no-data", "no-return"].contains(why));
                let later: u64 = later.map(|(_, count)| count).sum();
                (cloud.points() as u64 + later, cloud.dropped)
            })
        );
    }
}

fn check_cloud(cloud: &RawCloud) {
    let points = cloud.points();
    let finite = match &cloud.positions {
        Positions::F32(values) => {
            values.len() == 3 * points && values.iter().all(|x| x.is_finite())
        }
        Positions::F64(values) => {
            values.len() == 3 * points && values.iter().all(|x| x.is_finite())
        }
    };
    assert!(finite);
    assert!(
        cloud
            .colors
            .as_ref()
            .is_none_or(|colors| colors.len() == 3 * points)
    );
    assert!(
        cloud.normals.as_ref().is_none_or(
            |normals| normals.len() == 3 * points && normals.iter().all(|x| x.is_finite())
        )
    );
    assert!(
        cloud
            .attributes
            .iter()
            .all(|a| a.values.len() == points && a.values.iter().all(|x| x.is_finite()))
    );
    // What they say of viewpoints is what a cloud takes.
    assert!(points == 0 || cloud.to_cloud().is_ok());
}

/// Vertices, as [`read`] gives them.
fn vertices() -> ReadOptions {
    ReadOptions {
        faces: FaceMode::Vertices,
        ..Default::default()
    }
}

/// Points and rows left out.
fn read_slices(bytes: &[u8], size: usize, format: Format) -> pointweave::Result<(u64, usize)> {
    let mut reading = Reading::new(Some(format), None, bytes.len() as u64)
        .with_options(vertices())
        .expect("options");
    for slice in bytes.chunks(size) {
        reading.push(slice)?;
        reading.take_block();
    }
    while !reading.end()? {
        reading.take_block();
    }
    let summary = reading.summary();
    let skipped = summary.skipped.iter();
    let earlier = skipped.filter(|(why, _)| ["no-data", "no-return"].contains(why));
    let earlier: u64 = earlier.map(|(_, count)| count).sum();
    Ok((summary.points + earlier, summary.dropped))
}
