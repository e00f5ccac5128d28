//! Files of meshes, made for tests.

/// A PNG file of these pixels.
pub fn png(width: u32, height: u32, pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().expect("a header");
    writer
        .write_image_data(pixels.as_flattened())
        .expect("as many pixels");
    writer.finish().expect("an end");
    file
}

/// A GLB file of a square from 0 to 1 in x and y, with places that are its coordinates, one material, sampler and picture;
/// `node` is more of its node.
pub fn glb(material: &str, sampler: &str, node: &str, picture: &[u8]) -> Vec<u8> {
    let mut data: Vec<u8> = Vec::new();
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f32]];
    square
        .iter()
        .flat_map(|[x, y]| [*x, *y, 0.0])
        .for_each(|x| data.extend(x.to_le_bytes()));
    square
        .as_flattened()
        .iter()
        .for_each(|x| data.extend(x.to_le_bytes()));
    [0, 1, 2, 0, 2, 3u16]
        .iter()
        .for_each(|i| data.extend(i.to_le_bytes()));
    data.extend(picture);
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{node}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":2,"material":0}}]}}],
        "materials":[{material}],"textures":[{{"source":0,"sampler":0}}],"samplers":[{sampler}],"images":[{{"bufferView":3,"mimeType":"image/png"}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4}},{{"bufferView":1,"componentType":5126,"type":"VEC2","count":4}},
        {{"bufferView":2,"componentType":5123,"type":"SCALAR","count":6}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":32}},{{"buffer":0,"byteOffset":80,"byteLength":12}},
        {{"buffer":0,"byteOffset":92,"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]}}"#,
        picture.len(),
        data.len()
    );
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    data.resize(data.len().next_multiple_of(4), 0);
    let mut file = b"glTF".to_vec();
    file.extend(2u32.to_le_bytes());
    file.extend((28 + json.len() as u32 + data.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", &data)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}
