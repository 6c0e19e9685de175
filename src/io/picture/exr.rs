//! Reads and writes OpenEXR files of one part. A channel of a layer has a name such as `layer.channel`, by convention.

use std::io::{self, Cursor, Seek, Write};

use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
use exr::meta::attribute::{AttributeValue, Text};
use exr::meta::header::LayerAttributes;
use exr::prelude::{ReadChannels, ReadLayers, WritableImage, read as reader};

use serde_json::Value;

use super::{Channel, Layers};

/// Holds all of [`Layers::attributes`] as one JSON object.
const ATTRIBUTE: &str = "whitewater";

pub fn write(layers: &Layers, to: impl Write + Seek) -> io::Result<()> {
    let channels = layers
        .channels
        .iter()
        .map(|c| {
            AnyChannel::new(text(&c.name).unwrap_or_default(), FlatSamples::F32(c.data.clone()))
        })
        .collect();
    let mut attributes =
        LayerAttributes { software_name: text("whitewater"), ..Default::default() };
    if !layers.attributes.is_empty() {
        // All attributes are stored as one, because the crate writes several in a random order. The JSON is
        // ASCII, because EXR text is Latin-1.
        let map: serde_json::Map<String, Value> =
            layers.attributes.iter().map(|(k, v)| (k.clone(), Value::String(v.clone()))).collect();
        let json: String = Value::Object(map)
            .to_string()
            .chars()
            .map(|c| match c.len_utf8() {
                1 => c.to_string(),
                _ => c.encode_utf16(&mut [0; 2]).iter().map(|u| format!("\\u{u:04x}")).collect(),
            })
            .collect();
        if let (Some(name), Some(value)) = (text(ATTRIBUTE), text(&json)) {
            attributes.other.insert(name, AttributeValue::Text(value));
        }
    }
    let layer = Layer::new(
        (layers.width, layers.height),
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels),
    );
    Image::from_layer(layer).write().to_buffered(to).map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

fn text(value: &str) -> Option<Text> {
    Text::new_or_none(value)
}

pub fn read(bytes: &[u8]) -> Result<Layers, String> {
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| error.to_string())?;
    let layer = image.layer_data;
    let mut layers = Layers::new(layer.size.x(), layer.size.y());
    let pixels = layers.width * layers.height;
    for channel in layer.channel_data.list {
        let data: Vec<f32> = channel.sample_data.values_as_f32().collect();
        if data.len() != pixels {
            return Err(format!("channel {} at another resolution", channel.name));
        }
        layers.channels.push(Channel { name: channel.name.to_string(), data });
    }
    for (name, value) in layer.attributes.other {
        let AttributeValue::Text(value) = value else { continue };
        match serde_json::from_str(&value.to_string()) {
            Ok(Value::Object(map)) if text(ATTRIBUTE).as_ref() == Some(&name) => {
                for (name, value) in map {
                    layers.attributes.push((name, value.as_str().unwrap_or_default().into()));
                }
            }
            _ => layers.attributes.push((name.to_string(), value.to_string())),
        }
    }
    layers.attributes.sort();
    Ok(layers)
}
