//! What the coders decode is what was encoded, whatever it is; and decoding anything ends.

use luc_pack::codec::{cm, filter, interval::Decoder, lzma, small};
use luc_pack::encode::{self, Encoder};
use proptest::prelude::*;

/// What the model knows before, as it knows the launcher.
const LESSON: &[u8] = b"\x48\x8b\x44\x24\x08\xe8";

fn through_cm(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = Encoder::new();
    encode::cm(&mut encoder, LESSON, bytes, luc_pack::silent);
    let coded = encoder.finish();
    let mut memory = [LESSON, &vec![0; bytes.len()]].concat();
    let mut decoder = Decoder::new(&coded);
    cm::decode(&mut encode::new_model(), &mut memory, LESSON.len(), |one| decoder.bit(one));
    memory[LESSON.len()..].to_vec()
}

fn through_lzma(bytes: &[u8]) -> Vec<u8> {
    let mut output = vec![0; bytes.len()];
    lzma::decode(&encode::lzma(bytes), &mut output);
    output
}

fn through_small(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = Encoder::new();
    encode::small(&mut encoder, bytes);
    let mut coded = encoder.finish_in_full();
    coded.extend(b"rest");
    let mut output = vec![0; bytes.len()];
    let mut decoder = Decoder::new(&coded);
    small::decode(&mut encode::new_cells(), &mut output, |one| decoder.bit(one));
    assert_eq!(decoder.rest(), b"rest");
    output
}

/// Bytes with repetitions, near and far, and runs.
fn structured() -> impl Strategy<Value = Vec<u8>> {
    let piece = prop_oneof![
        proptest::collection::vec(any::<u8>(), 1..40),
        (any::<u8>(), 1..300usize).prop_map(|(byte, count)| vec![byte; count]),
        proptest::sample::select(vec![&b"\x48\x8b\x44\x24\x08\xe8"[..], b"\xc5\xfc\x58\x05", b"\0\0\x40\0"])
            .prop_map(<[u8]>::to_vec),
    ];
    proptest::collection::vec((piece, 1..4usize), 0..30)
        .prop_map(|pieces| pieces.into_iter().flat_map(|(piece, count)| piece.repeat(count)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..3000)) {
        prop_assert_eq!(&through_cm(&bytes), &bytes);
        prop_assert_eq!(&through_lzma(&bytes), &bytes);
        prop_assert_eq!(&through_small(&bytes), &bytes);
    }

    #[test]
    fn structured_bytes(bytes in structured()) {
        prop_assert_eq!(&through_cm(&bytes), &bytes);
        prop_assert_eq!(&through_lzma(&bytes), &bytes);
        prop_assert_eq!(&through_small(&bytes), &bytes);
    }

    #[test]
    fn decoding_nonsense_fills_the_output(bytes: Vec<u8>, length in 0..5000usize) {
        let mut output = vec![0; length];
        let mut decoder = Decoder::new(&bytes);
        cm::decode(&mut encode::new_model(), &mut output, 0, |one| decoder.bit(one));
        lzma::decode(&bytes, &mut output);
        let mut decoder = Decoder::new(&bytes);
        small::decode(&mut encode::new_cells(), &mut output, |one| decoder.bit(one));
        filter::filter(&mut output, 0, filter::Direction::Unpack);
    }
}

#[test]
fn the_shortest_inputs() {
    for bytes in [&b""[..], b"\0", b"a", b"\xff", b"ab", b"aa", &[0; 5], &[255; 70]] {
        assert_eq!(through_cm(bytes), bytes);
        assert_eq!(through_lzma(bytes), bytes);
        assert_eq!(through_small(bytes), bytes);
    }
}

#[test]
fn machine_code() {
    // This very test: its headers and symbols, and some of its machine code.
    let file = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    for part in [0..60_000, file.len() / 2..file.len() / 2 + 60_000] {
        let mut bytes = file[part].to_vec();
        filter::filter(&mut bytes, 0x1000, filter::Direction::Pack);
        assert!(through_cm(&bytes) == bytes);
        assert!(through_lzma(&bytes) == bytes);
        assert!(through_small(&bytes) == bytes);
    }
}
