//! A film of all frames in one file: H.264 in MP4, which every player and browser supports.

use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use muxide::api::{MuxerBuilder, VideoCodec};
use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Complexity, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange,
    RateControlMode, UsageType, VuiConfig,
};
use openh264::formats::YUVBuffer;

use crate::failure::{Failure, Kind, Outcome};
use crate::output;

/// Max number of pixels of a film along its longer edge and along its shorter edge: the limit of the H.264 encoder,
/// level 5.2.
const MOST: (u32, u32) = (3840, 2160);
/// Min quantizer, 0 (lossless) to 51; a step of 6 doubles the error.
const QUANTIZER: u8 = 18;
/// Bits per pixel of the bit rate: at least what that quantizer needs.
const BITS: f32 = 2.0;
/// Seconds between key frames, at which a player may start.
const KEY_SECONDS: f32 = 10.0;

/// Encoded frames.
struct Film {
    encoder: Encoder,
    size: (usize, usize),
    fps: f32,
    /// The bytes of each frame, and whether it is a key frame.
    frames: Vec<(Vec<u8>, bool)>,
}

/// A film and its output files, shared by the run and the Ctrl-C handler.
#[derive(Clone)]
pub struct Reel {
    film: Arc<Mutex<Film>>,
    files: Vec<PathBuf>,
}

impl Reel {
    /// `None` without output files.
    pub fn new(files: Vec<PathBuf>, size: (u32, u32), fps: f32) -> Outcome<Option<Self>> {
        if files.is_empty() {
            return Ok(None);
        }
        let film = Arc::new(Mutex::new(Film::new(size, fps)?));
        Ok(Some(Self { film, files }))
    }

    fn film(&self) -> MutexGuard<'_, Film> {
        self.film.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a frame, as [`Film::push`].
    pub fn push(&self, rgb: &[[f32; 3]]) -> Outcome<()> {
        self.film().push(rgb)
    }

    /// Writes the frames so far, if any.
    pub fn write(&self) -> Outcome<()> {
        let film = self.film();
        if film.frames.is_empty() {
            return Ok(());
        }
        self.files.iter().try_for_each(|path| output::write(path, |to| film.write(to)))
    }
}

/// Fails for a size that cannot be encoded.
pub fn check_size((width, height): (u32, u32)) -> Outcome<()> {
    if width % 2 != 0 || height % 2 != 0 {
        let even = (width.next_multiple_of(2), height.next_multiple_of(2));
        return Err(Failure::usage(format!(
            "--size: expected an even width and height for a film, found {width}x{height}; use {}x{}",
            even.0, even.1
        )));
    }
    let (long, short) = (width.max(height), width.min(height));
    if long > MOST.0 || short > MOST.1 || short < 16 {
        return Err(Failure::usage(format!(
            "--size: expected 16x16 to {}x{} for a film, found {width}x{height}; write numbered .png and encode those",
            MOST.0, MOST.1
        )));
    }
    Ok(())
}

impl Film {
    /// A film of this size and rate.
    fn new((width, height): (u32, u32), fps: f32) -> Outcome<Self> {
        let bits = (BITS * width as f32 * height as f32 * fps.clamp(1.0, 60.0)) as u32;
        let config = EncoderConfig::new()
            .usage_type(UsageType::CameraVideoRealTime)
            .complexity(Complexity::High)
            // The bit rate is so high that the min quantizer applies. To an encoder foam is noise, and a lower rate
            // would blur it first. (The encoder's constant-quantizer mode uses a quantizer of its own, 26.)
            .rate_control_mode(RateControlMode::Quality)
            .bitrate(BitRate::from_bps(bits))
            .qp(QpRange::new(QUANTIZER, QUANTIZER + 6))
            .max_frame_rate(FrameRate::from_hz(fps))
            .intra_frame_period(IntraFramePeriod::from_num_frames(
                (KEY_SECONDS * fps).ceil().max(1.0) as u32,
            ))
            // Frame skipping is on only because without it the encoder warns on stderr that it cannot hold the bit
            // rate. `push` makes sure that no frame is skipped.
            .skip_frames(true)
            .scene_change_detect(false)
            .background_detection(false)
            .vui(VuiConfig::bt709());
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config);
        let encoder = encoder.map_err(|error| failed(&error))?;
        Ok(Self { encoder, size: (width as usize, height as usize), fps, frames: Vec::new() })
    }

    /// Adds a frame: its pixels row by row from the top, sRGB from 0 to 1.
    fn push(&mut self, rgb: &[[f32; 3]]) -> Outcome<()> {
        let (width, height) = self.size;
        let picture = YUVBuffer::from_vec(planes(rgb, width), width, height);
        // A skipped frame would make the film too fast.
        for again in [false, true] {
            if again {
                self.encoder.force_intra_frame();
            }
            let encoded = self.encoder.encode(&picture).map_err(|error| failed(&error))?;
            let key = matches!(encoded.frame_type(), FrameType::IDR | FrameType::I);
            let bytes = encoded.to_vec();
            if !bytes.is_empty() {
                self.frames.push((bytes, key));
                return Ok(());
            }
        }
        Err(failed(&"a frame was skipped"))
    }

    /// Writes the frames so far.
    fn write(&self, mut to: impl Write) -> io::Result<()> {
        if self.frames.len() != 1 {
            return self.mux(to);
        }
        let mut bytes = Vec::new();
        self.mux(&mut bytes)?;
        lasting(&mut bytes, self.fps);
        to.write_all(&bytes)
    }

    fn mux(&self, to: impl Write) -> io::Result<()> {
        let (width, height) = (self.size.0 as u32, self.size.1 as u32);
        let fps = f64::from(self.fps);
        let box_error = |error: &dyn std::fmt::Display| io::Error::other(error.to_string());
        let mut muxer = MuxerBuilder::new(to)
            .video(VideoCodec::H264, width, height, fps)
            .build()
            .map_err(|error| box_error(&error))?;
        for (i, (frame, key)) in self.frames.iter().enumerate() {
            muxer.write_video(i as f64 / fps, frame, *key).map_err(|error| box_error(&error))?;
        }
        muxer.finish().map_err(|error| box_error(&error))
    }
}

/// Sets the duration of a film of one frame. The muxer takes that of the last frame from the one before it; without one
/// it is a tick of 1/90000 s, too short for a player. (ISO 14496-12, boxes `mvhd`, `tkhd`, `mdhd` and `stts`.)
fn lasting(bytes: &mut [u8], fps: f32) {
    const MOVIE_TICKS: f64 = 1000.0;
    const MEDIA_TICKS: f64 = 90_000.0;
    let ticks = |rate: f64| (rate / f64::from(fps)).round().max(1.0) as u32;
    // The boxes stand in `moov`, before or after the frame's bytes.
    let Some(moov) = top_level(bytes, b"moov") else { return };
    let Some(moov) = bytes.get_mut(moov) else { return };
    // Index of the word in the box, after its version and flags.
    for (kind, index, rate) in [
        (b"mvhd", 3, MOVIE_TICKS),
        (b"tkhd", 4, MOVIE_TICKS),
        (b"mdhd", 3, MEDIA_TICKS),
        (b"stts", 2, MEDIA_TICKS),
    ] {
        let Some(at) = moov.windows(4).position(|word| word == kind) else { continue };
        let from = at + 8 + 4 * index;
        if let Some(word) = moov.get_mut(from..from + 4) {
            word.copy_from_slice(&ticks(rate).to_be_bytes());
        }
    }
}

/// Where a box of a file lies.
fn top_level(bytes: &[u8], kind: &[u8; 4]) -> Option<std::ops::Range<usize>> {
    let mut at = 0;
    loop {
        let head = bytes.get(at..at + 8)?;
        let size = u32::from_be_bytes(head[..4].try_into().ok()?) as usize;
        if head[4..] == *kind {
            return Some(at..at + size);
        }
        // Sizes below 8 have a meaning of their own, which the muxer does not use.
        at += size.max(8);
    }
}

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::new(Kind::Output, format!("the film cannot be encoded: {error}"))
}

/// A picture as planar YUV 4:2:0: luma, then two chroma planes at half the size. ITU-R BT.709-6,
/// Sec. 3.2 and 3.4, 8 bits, limited range (16 to 235, chroma to 240). A chroma sample is the mean of two by two
/// pixels, which lies in their middle. The standard places the sample between the two rows, but on the left column
/// (H.264, Fig. E-1, type 0); the difference is half a pixel, as in most encoders.
fn planes(rgb: &[[f32; 3]], width: usize) -> Vec<u8> {
    let luma = |[r, g, b]: [f32; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let mut all: Vec<u8> =
        rgb.iter().map(|pixel| (16.5 + 219.0 * luma(*pixel).clamp(0.0, 1.0)) as u8).collect();
    let height = rgb.len() / width;
    for (channel, scale) in [(2, 1.8556), (0, 1.5748)] {
        for (x, y) in (0..height / 2).flat_map(|y| (0..width / 2).map(move |x| (2 * x, 2 * y))) {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| rgb[(y + j) * width + x + i]);
            let difference: f32 = four.iter().map(|p| p[channel] - luma(*p)).sum();
            let value = 224.0 * 0.25 * difference / scale;
            all.push((128.5 + value).clamp(16.0, 240.0) as u8);
        }
    }
    all
}

#[cfg(test)]
#[path = "../tests/tool/mp4.rs"]
mod mp4;

#[cfg(test)]
mod tests {
    use openh264::decoder::Decoder;
    use openh264::formats::YUVSource;

    use super::mp4::Frames;
    use super::*;

    #[test]
    fn sizes_that_cannot_be_filmed_are_named() {
        for good in [(1280, 720), (2160, 3840), (16, 16)] {
            check_size(good).unwrap();
        }
        for (bad, says) in [((1281, 720), "1282x720"), ((8, 8), "8x8"), ((4096, 2160), "3840x2160")]
        {
            let failure = check_size(bad).unwrap_err();
            assert_eq!(failure.kind, Kind::Usage);
            assert!(failure.message.contains(says), "{}", failure.message);
        }
    }

    /// Black, white and the primaries against the 8-bit tables of BT.709.
    #[test]
    fn colours_are_those_of_the_standard() {
        for (rgb, [y, cb, cr]) in [
            ([0.0, 0.0, 0.0], [16, 128, 128]),
            ([1.0, 1.0, 1.0], [235, 128, 128]),
            ([1.0, 0.0, 0.0], [63, 102, 240]),
            ([0.0, 1.0, 0.0], [173, 42, 26]),
            ([0.0, 0.0, 1.0], [32, 240, 118]),
        ] {
            assert_eq!(planes(&[rgb; 4], 2), [y, y, y, y, cb, cr], "{rgb:?}");
        }
    }

    /// A single frame lasts as long as one of several.
    #[test]
    fn a_film_of_one_frame_lasts() {
        let mut film = Film::new((32, 16), 24.0).unwrap();
        film.push(&[[0.5; 3]; 32 * 16]).unwrap();
        let mut bytes = Vec::new();
        film.write(&mut bytes).unwrap();
        let word = |kind: &[u8], index: usize| {
            let from = bytes.windows(4).position(|w| w == kind).unwrap() + 8 + 4 * index;
            u32::from_be_bytes(bytes[from..from + 4].try_into().unwrap())
        };
        assert_eq!([word(b"stts", 1), word(b"stts", 2)], [1, 3750]);
        assert_eq!([word(b"mdhd", 2), word(b"mdhd", 3)], [90_000, 3750]);
        assert_eq!([word(b"mvhd", 2), word(b"mvhd", 3), word(b"tkhd", 4)], [1000, 42, 42]);
    }

    /// The file gives the frames that were encoded, in their order and at their rate.
    #[test]
    fn a_film_holds_its_frames() {
        let (width, height) = (64, 32);
        let picture = |frame: usize| -> Vec<[f32; 3]> {
            let shade = |i: usize| [(i % width) as f32 / 64.0, frame as f32 / 12.0, 0.25];
            (0..width * height).map(shade).collect()
        };
        let mut film = Film::new((width as u32, height as u32), 24.0).unwrap();
        for frame in 0..12 {
            film.push(&picture(frame)).unwrap();
        }
        let mut bytes = Vec::new();
        film.write(&mut bytes).unwrap();
        assert_eq!(&bytes[4..8], b"ftyp");
        let read = Frames::of(&bytes);
        // A key frame every ten seconds; these are half a second.
        let keys: Vec<bool> = read.frames.iter().map(|(_, key)| *key).collect();
        assert_eq!(keys, (0..12).map(|frame| frame == 0).collect::<Vec<_>>());
        let word = |kind: &[u8], index: usize| {
            let from = bytes.windows(4).position(|w| w == kind).unwrap() + 8 + 4 * index;
            u32::from_be_bytes(bytes[from..from + 4].try_into().unwrap())
        };
        // One run of 12 frames, each a 24th of a second.
        assert_eq!([0, 1, 2].map(|index| word(b"stts", index)), [1, 12, 90_000 / 24]);
        let mut decoder = Decoder::new().unwrap();
        decoder.decode(&read.head).unwrap();
        for (number, (frame, _)) in read.frames.iter().enumerate() {
            let decoded = decoder.decode(frame).unwrap().unwrap();
            let planes = planes(&picture(number), width);
            let (luma, chroma) = planes.split_at(width * height);
            let (blue, red) = chroma.split_at(width * height / 4);
            let strides = decoded.strides();
            for (found, stride, expected, width) in [
                (decoded.y(), strides.0, luma, width),
                (decoded.u(), strides.1, blue, width / 2),
                (decoded.v(), strides.2, red, width / 2),
            ] {
                for (i, expected) in expected.iter().enumerate() {
                    let off = found[i / width * stride + i % width].abs_diff(*expected);
                    assert!(off <= 12, "frame {number}, {i}: {off} off");
                }
            }
        }
    }
}
