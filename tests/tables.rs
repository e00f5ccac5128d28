//! Tables of text as instruments, geographic information systems, viewers and spreadsheets write them.
#![cfg(not(target_arch = "wasm32"))]

use pointweave::cloud::Unit;
use pointweave::formats::{
    Format, Positions, Preview, RawCloud, ReadOptions, Reading, detect, read, read_with,
};

/// Point `i` of the tables here, with six digits.
fn place(i: usize) -> [f64; 3] {
    let i = i as f64;
    let round = |x: f64| (x * 1e6).round() / 1e6;
    [
        round((i * 1.7).sin()),
        round((i * 0.9).cos() - 0.5),
        round(1.0 + 0.01 * i),
    ]
}

/// Colour of point `i`.
fn color(i: usize) -> [u8; 3] {
    [
        (7 * i % 256) as u8,
        (40 + 13 * i % 200) as u8,
        (90 + 29 * i % 150) as u8,
    ]
}

/// Rows, a line each.
fn table(header: &str, row: impl Fn([String; 3], usize) -> String) -> String {
    let rows = (0..40).map(|i| row(place(i).map(|x| x.to_string()), i) + "\n");
    let header = if header.is_empty() {
        String::new()
    } else {
        format!("{header}\n")
    };
    header + &rows.collect::<String>()
}

fn values(cloud: &RawCloud) -> Vec<f64> {
    match &cloud.positions {
        Positions::F32(values) => values.iter().map(|&x| f64::from(x)).collect(),
        Positions::F64(values) => values.clone(),
    }
}

/// Reads a table and checks its places.
fn right(text: &str) -> RawCloud {
    let cloud = read(text.as_bytes(), Format::Xyz).unwrap_or_else(|e| panic!("{e}: {text:.80}"));
    assert_eq!(detect(text.as_bytes(), None), Ok(Format::Xyz), "{text:.80}");
    assert_eq!(cloud.points(), 40, "{text:.80}");
    for (found, expected) in values(&cloud).chunks_exact(3).zip((0..40).map(place)) {
        for axis in 0..3 {
            assert!(
                (found[axis] - expected[axis]).abs() < 1e-6,
                "{found:?} {expected:?} {text:.80}"
            );
        }
    }
    cloud
}

fn names(cloud: &RawCloud) -> Vec<&str> {
    cloud.attributes.iter().map(|a| a.name.as_str()).collect()
}

fn check_colors(cloud: &RawCloud, text: &str) {
    let colors = cloud
        .colors
        .as_ref()
        .unwrap_or_else(|| panic!("no colours: {text:.80}"));
    for (i, found) in colors.chunks_exact(3).enumerate() {
        let off = found.iter().zip(color(i)).map(|(a, b)| a.abs_diff(b)).max();
        assert!(off <= Some(1), "{found:?} {:?} {text:.80}", color(i));
    }
}

#[test]
fn names_of_columns_in_any_order() {
    let xyz = |[x, y, z]: [String; 3], _| format!("{x},{y},{z}");
    for header in [
        "X,Y,Z",
        "\"X\",\"Y\",\"Z\"",
        "X(m),Y(m),Z(m)",
        "X [m], Y [m], Z [m]",
        "x (US ft),y (US ft),z (US ft)",
        "Easting,Northing,Elevation",
        "E,N,H",
        "EASTING (m),NORTHING (m),HEIGHT (m)",
        "lon,lat,alt",
        "Longitude (deg),Latitude (deg),Ellipsoidal Height (m)",
        "Points:0,Points:1,Points:2",
        "\"Points_m_XYZ:0\",\"Points_m_XYZ:1\",\"Points_m_XYZ:2\"",
        "coords_0,coords_1,coords_2",
        "Rechtswert,Hochwert,Höhe",
        "Ostwert;Nordwert;Höhe",
        "Laengengrad,Breitengrad,Hoehe",
        "Est,Nord,Altitude",
        "# X,Y,Z",
        "//X,Y,Z",
        "#X Y Z",
        "Exported by a program\nX,Y,Z",
        "X,Y,Z\nm,m,m",
        // One word says the axis, the others are the same in all names.
        "world_x,world_y,world_z",
        "MeshX,MeshY,MeshZ",
        "pose.position.x,pose.position.y,pose.position.z",
        "X Location (m),Y Location (m),Z Location (m)",
        "X_L93,Y_L93,Z_NGF",
        "E_UTM32,N_UTM32,H_DHHN2016",
        "X0,Y0,Z0",
        "P[x],P[y],P[z]",
        // Other languages.
        "ESTE (m),NORTE (m),ELEVACIÓN (m)",
        "Coordenada X,Coordenada Y,Coordenada Z",
        "Leste,Norte,Cota",
        "X-coördinaat,Y-coördinaat,Hoogte",
        "Öst,Norr,Höjd",
        "Øst,Nord,Højde",
        "Wschód,Północ,Wysokość",
        "Souřadnice X,Souřadnice Y,Výška",
        "Восток,Север,Высота",
        "東,北,標高",
        // Above the names.
        "Scan 1 2 3 of 4\nX,Y,Z",
        "VARIABLES = \"X\", \"Y\", \"Z\"",
        "# columns: x y z",
    ] {
        let header = if header.contains(';') {
            &header.replace(';', ",")
        } else {
            header
        };
        let cloud = right(&table(header, xyz));
        assert_eq!(cloud.columns, ["x", "y", "z"], "{header}");
    }
    let other = table("Northing,Easting,Elevation", |[x, y, z], _| {
        format!("{y},{x},{z}")
    });
    assert_eq!(right(&other).columns, ["y", "x", "z"]);
    let other = table("latitude,longitude,altitude", |[x, y, z], _| {
        format!("{y},{x},{z}")
    });
    assert_eq!(right(&other).columns, ["y", "x", "z"]);
    let other = table("Point;Z [m];Y [m];X [m];Code", |[x, y, z], i| {
        format!("P{i};{z};{y};{x};7")
    });
    let cloud = right(&other);
    assert_eq!(cloud.columns, ["-", "z", "y", "x", "Code"]);
    assert_eq!(names(&cloud), ["Code"]);
    let latin = [
        &b"Rechtswert;Hochwert;H\xf6he\n"[..],
        table("", |[x, y, z], _| format!("{x};{y};{z}")).as_bytes(),
    ]
    .concat();
    assert_eq!(
        read(&latin, Format::Xyz).map(|cloud| cloud.columns),
        Ok(["x", "y", "z"].map(String::from).into())
    );
}

/// What a person is shown of a table.
fn preview(text: &str) -> Preview {
    let mut reading = Reading::new(Some(Format::Xyz), None, text.len() as u64);
    reading.push(text.as_bytes()).expect("rows");
    assert!(reading.end().expect("the end"));
    reading.summary().preview.expect("a preview")
}

#[test]
fn heights_of_other_names_and_depths_are_doubted() {
    let xyz = |[x, y, z]: [String; 3], _| format!("{x},{y},{z}");
    for (header, weak) in [
        ("lon_wgs84,lat_wgs84,ellipsoid_height", false),
        ("x,y,height above ground", true),
        ("X,Y,Depth", true),
        ("V1,V2,V3", true),
    ] {
        let text = table(header, xyz);
        assert_eq!(right(&text).columns, ["x", "y", "z"], "{header}");
        assert_eq!(preview(&text).weak, weak, "{header}");
    }
    // Numbers of columns are no point.
    let rows = table("", |[x, y, z], _| format!("{x}0,{y}0,{z}0"));
    let decimal = |line: &&str| line.split(',').all(|value| value.contains('.'));
    let rows: Vec<&str> = rows.lines().filter(decimal).collect();
    let numbered = read(
        format!("0,1,2\n{}", rows.join("\n")).as_bytes(),
        Format::Xyz,
    );
    assert_eq!(numbered.map(|cloud| cloud.points()), Ok(rows.len()));
}

#[test]
fn names_say_the_unit() {
    let xyz = |[x, y, z]: [String; 3], _| format!("{x},{y},{z}");
    for (header, unit) in [
        ("X [mm],Y [mm],Z [mm]", Some(Unit::Millimetre)),
        ("X (US ft),Y (US ft),Z (US ft)", Some(Unit::SurveyFoot)),
        ("x,y,z\nm,m,m", Some(Unit::Metre)),
        ("lon,lat,alt", Some(Unit::Degree)),
        ("x,y,z", None),
    ] {
        assert_eq!(right(&table(header, xyz)).unit, unit, "{header}");
    }
}

#[test]
fn words_of_other_things_are_no_axes() {
    let header = "vel_x,vel_y,vel_z,red_count,green_count,blue_count,x,y,z";
    let text = table(header, |[x, y, z], _| format!("1,2,3,4,5,6,{x},{y},{z}"));
    let cloud = right(&text);
    assert_eq!(cloud.columns.join(","), header);
    assert!(cloud.colors.is_none());
}

#[test]
fn titles_below_the_rows_and_names_again_are_passed_over() {
    let xyz = |[x, y, z]: [String; 3], _| format!("{x},{y},{z}");
    let text = table("Points:0,Points:1,Points:2", xyz);
    let (first, second) =
        text.split_at(text.match_indices('\n').nth(20).map_or(0, |(at, _)| at + 1));
    for text in [
        format!("{first}Points:0,Points:1,Points:2\n{second}"),
        format!("{text}\nEND OF FILE\n"),
        format!("{text}\u{1a}"),
        format!("{text}\0\0\0\0"),
    ] {
        right(&text);
    }
    let error = read(format!("{text}Total,40,rows\n").as_bytes(), Format::Xyz).expect_err("no row");
    assert_eq!(error.code(), "bad-file");
    // Names alone are no empty scan where rows follow that are none.
    let error = read(b"x;y;z\n1:2;3:4;5:6\n", Format::Xyz).expect_err("no rows");
    assert_eq!(error.code(), "bad-file");
}

#[test]
fn rows_in_brackets_and_quotes_in_quotes() {
    let xyz = |[x, y, z]: [String; 3], _| format!("({x}, {y}, {z})");
    right(&table("", xyz));
    right(&table("", |place, _| format!("[{}]", place.join(" "))));
    let text = table("x,y,z,label", |[x, y, z], i| {
        format!("{x},{y},{z},\"a \"\"b\"\", c{i}\"")
    });
    assert_eq!(right(&text).columns, ["x", "y", "z", "-"]);
}

#[test]
fn counts_of_scans_rows_and_columns_are_never_x() {
    for (front, roles) in [
        (
            (|i| format!("{}", i / 10)) as fn(usize) -> String,
            "-,x,y,z",
        ),
        (|i| format!("{} {}", i / 8, i % 8), "-,-,x,y,z"),
        (|i| format!("{} {} {}", i + 1, i / 8, i % 8), "-,-,-,x,y,z"),
    ] {
        let plain = |[x, y, z]: [String; 3]| format!("{x}0 {y}0 {z}0");
        let text = table("", |place, i| {
            let place = place.map(|x| if x.contains('.') { x } else { x + "." });
            format!("{} {}", front(i), plain(place))
        });
        assert_eq!(right(&text).columns.join(","), roles);
    }
    // Whole coordinates of a grid stay, with heights and normals behind them.
    let grid: String = (0..40)
        .map(|i| format!("{} {} {}.5 0.0 0.6 0.8\n", i / 8, i % 8, i % 3))
        .collect();
    let cloud = read(grid.as_bytes(), Format::Xyz).expect("a table");
    assert_eq!(cloud.columns.join(","), "x,y,z,nx,ny,nz");
}

#[test]
fn a_time_in_front_is_never_x() {
    for (start, step) in [(1.6e9, 0.1), (1.6e18, 1e8)] {
        let text = table("", |[x, y, z], i| {
            format!("{} {x} {y} {z}", start + step * i as f64)
        });
        assert_eq!(right(&text).columns, ["-", "x", "y", "z"]);
    }
}

#[test]
fn names_of_colours_and_normals() {
    for (header, wide) in [
        ("x,y,z,red,green,blue", 1),
        ("X,Y,Z,R,G,B", 1),
        ("X,Y,Z,Rouge,Vert,Bleu", 1),
        ("X,Y,Z,Rot,Grün,Blau", 1),
        ("X,Y,Z,RGB:0,RGB:1,RGB:2", 1),
        ("X,Y,Z,R(0-255),G(0-255),B(0-255)", 1),
        ("X,Y,Z,R,G,B", 257),
        ("x,y,z,ColorR,ColorG,ColorB", 1),
        ("x,y,z,R8,G8,B8", 1),
        ("x,y,z,red16,green16,blue16", 257),
        ("x,y,z,r [8bit],g [8bit],b [8bit]", 1),
        ("x,y,z,scalar_R,scalar_G,scalar_B", 1),
        ("x,y,z,rood,groen,blauw", 1),
        ("x,y,z,vermelho,verde,azul", 1),
    ] {
        let text = table(header, |[x, y, z], i| {
            let [r, g, b] = color(i).map(|c| u32::from(c) * wide);
            format!("{x},{y},{z},{r},{g},{b}")
        });
        check_colors(&right(&text), &text);
    }
    for header in [
        "x y z normal_x normal_y normal_z",
        "x y z vnx vny vnz",
        "X Y Z I J K",
    ] {
        let text = table(header, |[x, y, z], _| format!("{x} {y} {z} 0 0.6 0.8"));
        assert_eq!(
            right(&text).normals.map(|n| n[..3].to_vec()),
            Some(vec![0.0, 0.6, 0.8]),
            "{header}"
        );
    }
    let cells = table("x y z i j k", |[x, y, z], i| format!("{x} {y} {z} {i} 0 3"));
    assert_eq!(names(&right(&cells)), ["i", "j", "k"]);
}

#[test]
fn decimal_commas_with_any_delimiter() {
    let text = table("", |place, _| place.map(|x| x.replace('.', ",")).join(", "));
    assert_eq!(right(&text).columns, ["x", "y", "z"]);
    let comma = |x: &str| x.replace('.', ",");
    for delimiter in ["\t", " ", ";", "  ", " ; ", "|"] {
        for header in ["", "X\tY\tZ", "# survey"] {
            let header = header.replace(
                '\t',
                if delimiter.trim().is_empty() {
                    delimiter
                } else {
                    ";"
                },
            );
            if delimiter == "|" && header.contains(';') {
                continue;
            }
            let text = table(&header, |xyz, _| xyz.map(|x| comma(&x)).join(delimiter));
            right(&text);
        }
    }
    let quoted = table("X,Y,Z", |xyz, _| {
        xyz.map(|x| format!("\"{}\"", comma(&x))).join(",")
    });
    right(&quoted);
    let colored = table("", |[x, y, z], i| {
        let [r, g, b] = color(i);
        format!("{};{};{};{r};{g};{b}", comma(&x), comma(&y), comma(&z))
    });
    check_colors(&right(&colored), &colored);
}

#[test]
fn an_empty_cell_moves_no_column() {
    let text = table("x,y,z,intensity,red,green,blue", |[x, y, z], i| {
        let [r, g, b] = color(i);
        let intensity = if i % 3 == 1 {
            String::new()
        } else {
            "7".into()
        };
        format!("{x},{y},{z},{intensity},{r},{g},{b}")
    });
    let cloud = right(&text);
    check_colors(&cloud, &text);
    assert_eq!(cloud.attributes[0].values[..3], [7.0, 0.0, 7.0]);
    assert_eq!(cloud.replaced, 13);
    let tabs = table("x\ty\tz\ta\tb", |[x, y, z], _| {
        format!("{x}\t{y}\t{z}\t\t5")
    });
    assert_eq!(right(&tabs).attributes[1].values[0], 5.0);
    let ends = table("", |[x, y, z], i| {
        format!("{x},{y},{z}{}", if i % 2 == 0 { "," } else { "" })
    });
    right(&ends);
    for none in [
        "NaN",
        "nan",
        "-nan(ind)",
        "1.#QNAN",
        "N/A",
        "null",
        "NULL",
        "None",
        "nodata",
        "-",
        "***",
    ] {
        let text = table("x,y,z,a", |[x, y, z], i| {
            let z = if i == 20 { none } else { &z };
            format!("{x},{y},{z},1")
        });
        let cloud = read(text.as_bytes(), Format::Xyz).expect("a table");
        assert_eq!((cloud.points(), cloud.dropped), (39, 1), "{none}");
        assert_eq!(cloud.skipped, [("not-finite", 1)]);
    }
}

#[test]
fn a_running_number_is_never_x() {
    type Number = fn(usize) -> String;
    let numbers: [Number; 5] = [
        |i| (i + 1).to_string(),
        |i| i.to_string(),
        |i| (1 + 3 * i).to_string(),
        |i| (i * 7919 % 10_007).to_string(),
        |i| format!("P{i}"),
    ];
    for number in numbers {
        for delimiter in [" ", ",", "\t", ";"] {
            let text = table("", |xyz, i| {
                format!("{}{delimiter}{}", number(i), xyz.join(delimiter))
            });
            let cloud = right(&text);
            assert_eq!(cloud.columns, ["-", "x", "y", "z"]);
            let text = table("", |xyz, i| {
                let [r, g, b] = color(i).map(|c| c.to_string());
                [&number(i), &xyz[0], &xyz[1], &xyz[2], &r, &g, &b]
                    .map(String::as_str)
                    .join(delimiter)
            });
            check_colors(&right(&text), &text);
        }
    }
    let pandas = table(",x,y,z", |xyz, i| format!("{i},{}", xyz.join(",")));
    assert_eq!(right(&pandas).columns, ["-", "x", "y", "z"]);
    let unnamed = table(",0,1,2", |xyz, i| format!("{i},{}", xyz.join(",")));
    assert_eq!(right(&unnamed).columns, ["-", "x", "y", "z"]);
    let r = table("\"x\" \"y\" \"z\"", |xyz, i| {
        format!("\"{}\" {}", i + 1, xyz.join(" "))
    });
    assert_eq!(right(&r).columns, ["-", "x", "y", "z"]);
    // Whole coordinates are coordinates.
    let voxels: String = (0..40)
        .map(|i| format!("{} {} {} 9\n", i % 4, i / 4 % 4, i / 16))
        .collect();
    let cloud = read(voxels.as_bytes(), Format::Xyz).expect("voxels");
    assert_eq!(cloud.columns, ["x", "y", "z", "intensity"]);
}

#[test]
fn points_of_colmap() {
    let header = "# 3D point list with one line of data per point:\n#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n# Number of points: 40, mean track length: 3";
    for head in [header, ""] {
        for unequal in [false, true] {
            let text = table(head, |[x, y, z], i| {
                let [r, g, b] = color(i);
                let track: String = (0..2 + if unequal { i % 4 } else { 0 })
                    .map(|k| format!(" {} {}", k + 1, 5 * i + k))
                    .collect();
                format!(
                    "{} {x} {y} {z} {r} {g} {b} 0.5{}{track}",
                    1 + i * 37 % 101,
                    i % 10
                )
            });
            let cloud = right(&text);
            check_colors(&cloud, &text);
            assert_eq!(cloud.columns[1..7], ["x", "y", "z", "red", "green", "blue"]);
        }
    }
}

#[test]
fn a_list_before_the_place_is_a_column_like_others() {
    let text = table("id,tags[],x,y,z", |[x, y, z], i| {
        format!("{i},a,{x},{y},{z}")
    });
    assert_eq!(right(&text).columns, ["id", "-", "x", "y", "z"]);
}

#[test]
fn colours_without_names() {
    let text = table("", |[x, y, z], i| {
        format!(
            "{x} {y} {z} {}",
            color(i).map(|c| (u32::from(c) * 257).to_string()).join(" ")
        )
    });
    check_colors(&right(&text), &text);
    let text = table("", |[x, y, z], i| {
        format!(
            "{x} {y} {z} {}",
            color(i)
                .map(|c| (f64::from(c) / 255.0).to_string())
                .join(" ")
        )
    });
    check_colors(&right(&text), &text);
    // Among more columns than have a known order.
    for (before, after) in [
        ("12 3", "7.5"),
        ("0.25 12", "3"),
        ("1 2", "0 0.6 0.8"),
        ("0 0.6 0.8 3", "1"),
        ("", "1 2 3.5"),
    ] {
        for wide in [1, 257] {
            let text = table("", |[x, y, z], i| {
                let rgb = color(i)
                    .map(|c| (u32::from(c) * wide).to_string())
                    .join(" ");
                format!("{x} {y} {z} {before} {rgb} {after}")
            });
            let cloud = right(&text);
            check_colors(&cloud, &text);
            assert_eq!(
                cloud.normals.is_some(),
                before.contains("0.6") || after.contains("0.6")
            );
        }
    }
}

#[test]
fn packed_colours() {
    let packed = |i: usize| {
        color(i)
            .iter()
            .fold(0u32, |all, &c| all << 8 | u32::from(c))
    };
    type Write = fn(u32) -> String;
    let kinds: [(&str, Write); 8] = [
        ("x,y,z,rgb", |c| c.to_string()),
        ("x,y,z,RGBA", |c| (c | 0xff00_0000).to_string()),
        ("x,y,z,color", |c| format!("{}.0", c)),
        ("x,y,z,rgb", |c| ((c | 0xff00_0000) as i32).to_string()),
        ("x,y,z,hex", |c| format!("#{c:06x}")),
        ("x,y,z,Color", |c| format!("0x{c:06X}")),
        ("x,y,z,hex", |c| format!("{c:06X}")),
        ("x,y,z,rgb", |c| format!("\"#{c:06X}\"")),
    ];
    for (header, write) in kinds {
        let text = table(header, |[x, y, z], i| {
            format!("{x},{y},{z},{}", write(packed(i)))
        });
        check_colors(&right(&text), &text);
    }
    for write in [kinds[0].1, kinds[4].1, kinds[5].1] {
        let text = table("", |[x, y, z], i| {
            format!("{x} {y} {z} {}", write(packed(i)))
        });
        check_colors(&right(&text), &text);
    }
    type Text = fn([u8; 3]) -> String;
    let texts: [(&str, Text); 4] = [
        ("x;y;z;color", |[r, g, b]| format!("rgb({r}, {g}, {b})")),
        ("x;y;z;color", |[r, g, b]| format!("({r},{g},{b})")),
        // Hexadecimal digits, and the bits of a number, without a name.
        ("", |[r, g, b]| format!("{r:02X}{g:02X}{b:02X}")),
        ("", |[r, g, b]| {
            format!("{:e}", f32::from_bits(u32::from_be_bytes([0, r, g, b])))
        }),
    ];
    for (header, write) in texts {
        let text = table(header, |[x, y, z], i| {
            format!("{x};{y};{z};{}", write(color(i)))
        });
        check_colors(&right(&text), &text);
    }
    let named = table("x,y,z,color", |[x, y, z], _| format!("{x},{y},{z},grey"));
    assert_eq!(right(&named).columns, ["x", "y", "z", "-"]);
    let class = table("x,y,z,color", |[x, y, z], i| {
        format!("{x},{y},{z},{}", i % 5)
    });
    assert_eq!(names(&right(&class)), ["color"]);
}

#[test]
fn a_caller_says_what_the_columns_are() {
    let ask = |text: &str, columns: &str, options: ReadOptions| {
        let columns = columns.split(',').map(String::from).collect();
        let options = ReadOptions {
            columns: Some(columns),
            ..options
        };
        read_with(text.as_bytes(), Format::Xyz, &options)
    };
    let text = table("a,b,c,d", |[x, y, z], i| format!("{z},{i},{x},{y}"));
    assert_eq!(
        read(text.as_bytes(), Format::Xyz).map_err(|e| (e.code(), e.index())),
        Err(("bad-file", Some(1)))
    );
    let cloud = ask(&text, "z,-,x,y", ReadOptions::default()).expect("columns");
    assert_eq!(cloud.columns, ["z", "-", "x", "y"]);
    assert!((values(&cloud)[3] - place(1)[0]).abs() < 1e-6 && cloud.attributes.is_empty());
    let cloud = ask(&text, "z,weight,X,Y", ReadOptions::default()).expect("columns");
    assert_eq!(names(&cloud), ["weight"]);
    // What was told says the same again.
    let again = ask(&text, &cloud.columns.join(","), ReadOptions::default());
    assert_eq!(again.as_ref(), Ok(&cloud));
    // Columns beyond are passed over, and those that are not there are an error.
    assert!(ask(&text, "x,y,z", ReadOptions::default()).is_ok());
    let error = ask(&text, "x,y,z,a,b", ReadOptions::default()).expect_err("too many");
    assert_eq!((error.code(), error.index()), ("bad-file", Some(2)));
    for columns in ["x,y", "a,b,c", ""] {
        let error = ask(&text, columns, ReadOptions::default()).expect_err("no z");
        assert_eq!(error.code(), "bad-option", "{columns}");
    }
    let skipped = format!("1 2 3\n4 5 6\n{text}");
    let options = ReadOptions {
        skip: 3,
        ..Default::default()
    };
    let cloud = ask(&skipped, "z,-,x,y", options).expect("skipped");
    assert_eq!(cloud.points(), 40);
    let odd = "1:2:3\n4:5:6\n";
    let options = ReadOptions {
        delimiter: Some(':'),
        ..Default::default()
    };
    assert_eq!(
        read_with(odd.as_bytes(), Format::Xyz, &options).map(|c| c.points()),
        Ok(2)
    );
    let commas = "1,5 2,5 3,5\n";
    let options = ReadOptions {
        delimiter: Some(' '),
        decimal: Some(','),
        ..Default::default()
    };
    let cloud = read_with(commas.as_bytes(), Format::Xyz, &options).expect("commas");
    assert_eq!(values(&cloud), [1.5, 2.5, 3.5]);
    for options in [
        ReadOptions {
            decimal: Some(';'),
            ..Default::default()
        },
        ReadOptions {
            decimal: Some(','),
            delimiter: Some(','),
            ..Default::default()
        },
        ReadOptions {
            delimiter: Some('x'),
            ..Default::default()
        },
    ] {
        let error = read_with(commas.as_bytes(), Format::Xyz, &options).expect_err("a bad option");
        assert_eq!(error.code(), "bad-option");
    }
}

#[test]
fn the_first_rows_are_shown_and_doubt_is_said() {
    let named = preview(&table("X;Y;Z", |xyz, _| {
        xyz.map(|x| x.replace('.', ",")).join(";")
    }));
    assert_eq!(
        (named.delimiter, named.decimal, named.weak),
        (';', ',', false)
    );
    assert_eq!(named.names, ["X", "Y", "Z"]);
    assert_eq!(named.rows.len(), 8);
    assert_eq!(
        named.rows[0],
        place(0).map(|x| x.to_string().replace('.', ","))
    );
    assert!(!preview(&table("", |xyz, _| xyz.join(" "))).weak);
    assert!(preview(&table("", |xyz, i| format!("{i} {}", xyz.join(" ")))).weak);
    assert!(preview(&table("", |xyz, i| format!("{} 5 {i}", xyz.join(" ")))).weak);
}

#[test]
fn slices_and_a_long_table_give_the_same() {
    let rows: String = (0..2500)
        .map(|i| {
            format!(
                "{}\t{}\t{}\t{}\n",
                i + 1,
                place(i)[0],
                place(i)[1],
                place(i)[2]
            )
        })
        .collect();
    let whole = read(rows.as_bytes(), Format::Xyz).expect("rows");
    let mut reading = Reading::new(None, Some("a.txt"), rows.len() as u64);
    let mut points = 0;
    for slice in rows.as_bytes().chunks(777) {
        reading.push(slice).expect("a slice");
        points += reading
            .take_block()
            .map_or(0, |(block, _)| block.positions.len() / 3);
    }
    assert!(reading.end().expect("the end"));
    points += reading
        .take_block()
        .map_or(0, |(block, _)| block.positions.len() / 3);
    assert_eq!((points, whole.points()), (2500, 2500));
    assert_eq!(reading.summary().columns, whole.columns);
    let broken = format!("{rows}1\t2\tx\t4\n");
    let error = read(broken.as_bytes(), Format::Xyz).expect_err("a word");
    assert_eq!((error.code(), error.index()), ("bad-file", Some(2501)));
}

#[test]
fn names_are_looked_for_in_the_lines_next_above_the_rows() {
    let first = |between: usize| {
        let notes = "# nothing of the columns is said here\n".repeat(between);
        let text = table(&format!("# z y x\n{notes}#"), |[x, y, z], _| {
            format!("{z} {y} {x}")
        });
        values(&read(text.as_bytes(), Format::Xyz).unwrap())[..3].to_vec()
    };
    let [x, y, z] = place(0);
    assert_eq!(first(20), [x, y, z]);
    assert_eq!(first(100), [z, y, x]);
}
