//! Frames with whatever is in them.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use proptest::{collection, prelude::*, sample};
use tabletop_wire::{ActionChunk, Dtype, NumpyArray, WireMap, WireValue, decode, encode};

fn arrays() -> impl Strategy<Value = NumpyArray> {
    let shapes = collection::vec(0..5_usize, 0..4);
    (sample::select(&Dtype::ALL[..]), shapes).prop_flat_map(|(dtype, shape)| {
        let count = shape.iter().product::<usize>() * dtype.bytes();
        let bytes = collection::vec(any::<u8>(), count);
        bytes.prop_map(move |bytes| NumpyArray::new(dtype, shape.clone(), bytes).unwrap())
    })
}

fn values() -> impl Strategy<Value = WireValue> {
    let leaves = prop_oneof![
        Just(WireValue::Nil),
        any::<bool>().prop_map(WireValue::Boolean),
        any::<i64>().prop_map(WireValue::Integer),
        (-200_i64..200).prop_map(WireValue::Integer),
        proptest::num::f64::NORMAL.prop_map(WireValue::Number),
        ".{0,40}".prop_map(WireValue::Text),
        collection::vec(any::<u8>(), 0..300).prop_map(WireValue::Bytes),
        arrays().prop_map(WireValue::Array),
    ];
    leaves.prop_recursive(4, 60, 20, |inner| {
        prop_oneof![
            collection::vec(inner.clone(), 0..20).prop_map(WireValue::List),
            maps(inner).prop_map(WireValue::Map),
        ]
    })
}

fn maps(values: impl Strategy<Value = WireValue>) -> impl Strategy<Value = WireMap> {
    collection::btree_map("[a-z/]{0,12}", values, 0..20)
}

proptest! {
    #[test]
    fn what_is_sent_is_received(map in maps(values())) {
        prop_assert_eq!(decode(&encode(&map)).unwrap(), WireValue::Map(map));
    }

    #[test]
    fn any_bytes_are_a_value_or_a_fault(bytes in collection::vec(any::<u8>(), 0..400)) {
        if let Ok(WireValue::Map(map)) = decode(&bytes) {
            drop(ActionChunk::of(&map, 7, 1));
        }
    }

    #[test]
    fn the_beginning_of_a_frame_is_a_fault(map in maps(values()), end in any::<sample::Index>()) {
        let bytes = encode(&map);
        decode(&bytes[..end.index(bytes.len())]).unwrap_err();
    }

    #[test]
    fn a_damaged_frame_is_a_value_or_a_fault(
        map in maps(values()),
        damage in collection::vec((any::<sample::Index>(), any::<u8>()), 1..4),
        end in any::<sample::Index>(),
    ) {
        let mut bytes = encode(&map);
        for (place, byte) in damage {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        drop(decode(&bytes));
        bytes.truncate(end.index(bytes.len()));
        drop(decode(&bytes));
    }

    #[test]
    fn actions_have_the_shape_that_was_asked_for(
        array in arrays(),
        columns in 0..4_usize,
        horizon in 0..4_usize,
    ) {
        let answer = WireMap::from([("actions".to_owned(), array.into())]);
        if let Ok(chunk) = ActionChunk::of(&answer, columns, horizon) {
            prop_assert_eq!(chunk.rows().len(), horizon.max(1));
            prop_assert!(chunk.rows().iter().all(|row| row.len() == columns));
            prop_assert!(chunk.rows().iter().flatten().all(|number| number.is_finite()));
        }
    }
}

/// The bytes that Python's `msgpack` writes for a map of one array.
#[test]
fn an_array_is_as_openpi_writes_it() {
    let array = NumpyArray::of_floats(&[1, 2], &[1.0, -2.0]);
    let map = WireMap::from([("a".to_owned(), array.into())]);
    let mut expected = b"\x81\xa1a\x84\xc4\x0b__ndarray__\xc3\xc4\x04data\xc4\x08".to_vec();
    expected.extend([1.0_f32, -2.0].into_iter().flat_map(f32::to_le_bytes));
    expected.extend(b"\xc4\x05dtype\xa3<f4\xc4\x05shape\x92\x01\x02");
    assert_eq!(encode(&map), expected);
}
