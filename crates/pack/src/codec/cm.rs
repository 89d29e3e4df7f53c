//! Decodes what was packed by the method `cm`: the bits are the arithmetic decoder's, what they
//! mean is the model's.

use super::interval::Decoder;
use super::model::Model;

/// Decodes `input` until `output` is full. `model` is new, that is all zero.
pub fn decode(model: &mut Model, input: &[u8], output: &mut [u8]) {
    let mut decoder = Decoder::new(input);
    model.start();
    for position in 0..output.len() {
        let mut byte = 1;
        while byte < 256 {
            let bit = decoder.bit(model.predict());
            model.learn(bit);
            byte = byte << 1 | bit;
        }
        if let Some(place) = output.get_mut(position) {
            *place = byte as u8;
        }
        model.end_byte(output.get(..position + 1).unwrap_or(&[]));
    }
}
