//! Which side is out, on scans whose outer side is known.

mod common;

use common::scenes::{Sure, all};
use pointweave::SurfaceParams;

#[test]
fn every_scene_is_right_side_out() {
    let only = std::env::var("SCENES").unwrap_or_default();
    let mut failures = Vec::new();
    for recipe in all()
        .iter()
        .filter(|r| r.name.contains(&only) || r.kind.contains(&only))
    {
        let mut line = format!("{:20} {:45}", recipe.kind, recipe.name);
        for seed in std::env::var("SEED").map_or(0, |s| s.parse().unwrap())
            ..std::env::var("SEEDS").map_or(8, |s| s.parse().unwrap())
        {
            let scene = recipe.scene(seed);
            let surface = scene.surface(&SurfaceParams::default());
            let right = scene.right(&surface);
            if std::env::var("SITES").is_ok() {
                let cloud = &surface.cloud.reduced.cloud;
                let frame = cloud.frame;
                let (mut r, mut all) = (0, 0);
                for (p, n) in cloud.points.iter().zip(cloud.normals.as_ref().unwrap()) {
                    let q = glam::DVec3::from_array(frame.to_caller(*p));
                    if let Some(is) = (scene.truth)(q, n.as_dvec3()) {
                        all += 1;
                        r += usize::from(is);
                        if !is {
                            println!("   wrong at {q:.3} {n:.2}");
                        }
                    }
                }
                println!("  sites {r} of {all}");
            }
            let doubts = &surface.report.reduce.doubts;
            let least = match scene.sure {
                Sure::Closed => right >= 0.999 && doubts.is_empty(),
                Sure::Told => right >= 0.99,
                Sure::Guess => right.max(1.0 - right) >= 0.999 && !doubts.is_empty(),
            };
            let codes: Vec<&str> = doubts.iter().map(|d| d.code).collect();
            line += &format!(
                " {}{right:.4}{}",
                if least { "" } else { "!" },
                if codes.is_empty() {
                    String::new()
                } else {
                    format!("{codes:?}")
                }
            );
            if std::env::var("SHOW").is_ok() {
                println!(
                    "{} {:?} {:?}",
                    recipe.name, surface.report.orientation, surface.report.reduce.ms
                );
            }
            if !least {
                failures.push(format!("{} {seed}", recipe.name));
            }
        }
        println!("{line}");
    }
    println!("{} failures", failures.len());
    assert!(failures.is_empty(), "{failures:?}");
}
