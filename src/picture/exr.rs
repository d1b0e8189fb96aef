//! Linear light as OpenEXR, so that compositing programs read it: f32, losslessly packed.

use std::io::Cursor;

use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, WritableImage,
};

/// A picture that could not be put into OpenEXR.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("as OpenEXR: {0}")]
pub struct ExrError(String);

/// The bytes of an OpenEXR file of planes of so many columns, row 0 on top. One plane is called Y, three R, G and B, any other number B1,
/// B2 and so on.
///
/// # Errors
/// What the format does not take (planes of different sizes, none).
pub fn planes(width: usize, planes: &[Vec<f32>]) -> Result<Vec<u8>, ExrError> {
    let height = planes.first().map_or(0, |plane| plane.len().checked_div(width).unwrap_or(0));
    if width * height == 0 || planes.iter().any(|plane| plane.len() != width * height) {
        return Err(ExrError(format!("{} planes of {width} columns are no picture", planes.len())));
    }
    let name = |index: usize| match planes.len() {
        1 => "Y".to_owned(),
        3 => ["R", "G", "B"].map(str::to_owned)[index].clone(),
        _ => format!("B{:02}", index + 1),
    };
    let channel = |(index, plane): (usize, &Vec<f32>)| AnyChannel::new(&*name(index), FlatSamples::F32(plane.clone()));
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = planes.iter().enumerate().map(channel).collect();
    let attributes = LayerAttributes::named("radiance");
    let layer = Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    let image = Image::from_layer(layer);
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|error| ExrError(error.to_string()))?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use ::exr::prelude::{ReadChannels, ReadLayers, read};

    use super::*;

    #[test]
    fn what_is_written_is_read_back_by_the_format_s_own_reader() {
        let colours = [vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], vec![0.1; 6], vec![1e-30; 6]];
        let bytes = planes(3, &colours).unwrap();
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .unwrap();
        let layer = image.layer_data;
        assert_eq!((layer.size.x(), layer.size.y()), (3, 2));
        let names: Vec<String> = layer.channel_data.list.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "R"]);
        let values: Vec<f32> = layer.channel_data.list[2].sample_data.values_as_f32().collect();
        assert_eq!(values, colours[0]);
        assert!(planes(3, &[]).is_err() && planes(4, &colours).is_err());
    }
}
