//! The frames of a film, read from its boxes: `avcC`, `stsc`, `stco`, `stsz`, `stss` (ISO 14496-12 and 14496-15).

/// What a decoder needs before the first frame, then the frames in order, each with whether it is a key frame.
pub struct Frames {
    pub head: Vec<u8>,
    pub frames: Vec<(Vec<u8>, bool)>,
}

impl Frames {
    pub fn of(bytes: &[u8]) -> Self {
        let find = |kind: &[u8]| bytes.windows(4).position(|w| w == kind).map(|at| at + 4);
        let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        // The words of a table after its version and flags.
        let table = |kind: &[u8], index: usize| word(find(kind).unwrap() + 4 + 4 * index);
        let (mut head, mut at) = (Vec::new(), find(b"avcC").unwrap() + 5);
        assert_eq!(bytes[at - 1] & 3, 3, "lengths of four bytes");
        // Sequence parameter sets, then picture parameter sets.
        for mask in [0x1f, 0xff] {
            let count = bytes[at] & mask;
            at += 1;
            for _ in 0..count {
                let size = usize::from(u16::from_be_bytes([bytes[at], bytes[at + 1]]));
                head.extend(unit(&bytes[at + 2..at + 2 + size]));
                at += 2 + size;
            }
        }
        assert_eq!((table(b"stsc", 0), table(b"stsz", 0)), (1, 0), "chunks alike, sizes listed");
        let (per_chunk, count) = (table(b"stsc", 2), table(b"stsz", 1));
        let keys = find(b"stss")
            .map(|_| (0..table(b"stss", 0)).map(|i| table(b"stss", 1 + i)).collect::<Vec<_>>());
        let (mut frames, mut from) = (Vec::new(), 0);
        for i in 0..count {
            if i % per_chunk == 0 {
                from = table(b"stco", 1 + i / per_chunk);
            }
            let to = from + table(b"stsz", 2 + i);
            let mut frame = Vec::new();
            while from < to {
                let size = word(from);
                frame.extend(unit(&bytes[from + 4..from + 4 + size]));
                from += 4 + size;
            }
            // Without the table every frame is a key frame.
            let key = keys.as_ref().is_none_or(|keys| keys.contains(&(i + 1)));
            frames.push((frame, key));
        }
        Self { head, frames }
    }
}

/// A unit with a start code in place of its length.
fn unit(bytes: &[u8]) -> Vec<u8> {
    [&[0, 0, 0, 1], bytes].concat()
}
