//! Arrays are read as they are written, and nothing else is.

use super::*;
use proptest::prelude::*;

fn written<T: Element>(shape: &[usize], values: &[T]) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(shape, values, &mut bytes).unwrap();
    bytes
}

/// A file of version 1 with this header.
fn file(header: &str, data: &[u8]) -> Vec<u8> {
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [MAGIC, &[1, 0], &length, header.as_bytes(), data].concat()
}

fn of_type(descr: &str) -> Vec<u8> {
    file(&format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1,), }}"), &[0; 8])
}

fn of_shape(shape: &str, bytes: usize) -> Vec<u8> {
    file(&format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}"), &vec![0; bytes])
}

/// Shapes of up to three axes, some of length 0, each with the bits of its numbers.
fn arrays() -> impl Strategy<Value = (Vec<usize>, Vec<u32>)> {
    let bits = |shape: Vec<usize>| {
        let count: usize = shape.iter().product();
        (Just(shape), prop::collection::vec(any::<u32>(), count))
    };
    prop::collection::vec(0_usize..6, 0..4).prop_flat_map(bits)
}

proptest! {
    #[test]
    fn what_is_written_reads_back((shape, bits) in arrays()) {
        let bytes = written(&shape, &bits);
        prop_assert_eq!(bytes.len() % 64, bits.len() * 4 % 64, "the data begin at a multiple of 64");
        let array = read::<u32>(&bytes).unwrap();
        prop_assert_eq!((&array.shape, &array.values[..]), (&shape, &bits[..]));

        // Any bits may be an f32, NaN with a payload too.
        let floats: Vec<f32> = bits.iter().map(|&bits| f32::from_bits(bits)).collect();
        let bytes = written(&shape, &floats);
        let array = read::<f32>(&bytes).unwrap();
        prop_assert!(array.values.iter().zip(&bits).all(|(value, &bits)| value.to_bits() == bits));
        prop_assert_eq!(array.shape, shape);
    }

    #[test]
    fn bytes_at_any_address_are_read(offset in 0_usize..8) {
        let bytes = written(&[3], &[1_u32, 0x0102_0304, u32::MAX]);
        let moved = [&vec![0; offset], bytes.as_slice()].concat();
        prop_assert_eq!(&read::<u32>(&moved[offset..]).unwrap().values[..], &[1, 0x0102_0304, u32::MAX]);
    }

    #[test]
    fn any_bytes_end_in_an_array_or_a_message(bytes: Vec<u8>, header in "[ {}'a-z_<>0-9:,()TF]{0,60}") {
        let _ = read::<f32>(&bytes);
        let _ = read::<f32>(&[MAGIC, &bytes].concat());
        let _ = read::<f32>(&file(&header, &bytes));
    }
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let bytes = written(&[2, 3], &[0.5_f32; 6]);
    for length in 0..bytes.len() {
        let message = read::<f32>(&bytes[..length]).unwrap_err();
        assert!(message.contains("cut off") || length == 0, "cut after {length} bytes: {message}");
    }
}

#[test]
fn a_file_with_any_byte_changed_ends_in_an_array_or_a_message() {
    let bytes = written(&[2, 3], &[0.5_f32; 6]);
    for position in 0..bytes.len() {
        for byte in 0..=u8::MAX {
            let mut changed = bytes.clone();
            changed[position] = byte;
            if let Ok(array) = read::<f32>(&changed) {
                let count: usize = array.shape.iter().product();
                assert_eq!(array.values.len(), count, "byte {position} is {byte}");
            }
        }
    }
}

#[test]
fn the_three_versions_differ_in_the_length_of_their_header() {
    let header = "{'descr': '<u4', 'fortran_order': False, 'shape': (1,), }\n";
    let long = u32::try_from(header.len()).unwrap().to_le_bytes();
    let expected = written(&[1], &[7_u32]);
    let expected = read::<u32>(&expected);
    for (version, length) in [(1, &long[..2]), (2, &long[..]), (3, &long[..])] {
        let bytes = [MAGIC, &[version, 0], length, header.as_bytes(), &[7, 0, 0, 0]].concat();
        assert_eq!(read::<u32>(&bytes), expected, "version {version}");
    }
}

#[test]
fn numbers_are_little_endian_in_c_order() {
    let bytes = written(&[2, 2], &[1_u32, 2, 3, 0x0403_0201]);
    assert!(bytes.ends_with(&[1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 1, 2, 3, 4]));
    assert_eq!(read::<u32>(&bytes).unwrap().rows(), Ok(&[[1, 2], [3, 0x0403_0201]][..]));
}

#[test]
fn no_rows_are_rows_too() {
    let bytes = written::<f32>(&[0, 8], &[]);
    assert_eq!(read::<f32>(&bytes).unwrap().rows::<8>(), Ok(&[][..]));
}

#[test]
fn rows_are_of_one_width() {
    let message = |shape: &[usize]| {
        let bytes = written(shape, &vec![0.0_f32; shape.iter().product()]);
        read::<f32>(&bytes).unwrap().rows::<3>().unwrap_err()
    };
    assert_eq!(message(&[5, 4]), "the array's shape is (5, 4); it must be (N, 3)");
    assert_eq!(message(&[6]), "the array's shape is (6,); it must be (N, 3) (try .reshape(-1, 3))");
    assert_eq!(message(&[7]), "the array's shape is (7,); it must be (N, 3)");
    assert_eq!(message(&[]), "the array's shape is (); it must be (N, 3)");
    assert_eq!(message(&[2, 2, 3]), "the array's shape is (2, 2, 3); it must be (N, 3)");
}

#[test]
fn what_users_write_by_mistake_is_refused_with_what_would_be_right() {
    let fortran = file("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }", &[0; 24]);
    for (what, bytes, expected) in [
        ("nothing", vec![], "the file is empty; np.save writes an NPY file"),
        ("text", b"1 2 3".to_vec(), "this is not an NPY file; np.save writes one"),
        ("savez", b"PK\x03\x04".to_vec(), "save this array with np.save"),
        ("version 4", [MAGIC, &[4, 0, 0, 0]].concat(), "this is NPY version 4.0; versions 1.0, 2.0 and 3.0"),
        ("float64", of_type("<f8"), "are float64; they must be float32: convert with .astype(np.float32)"),
        (
            "big-endian",
            of_type(">f4"),
            "are big-endian float32; they must be float32: convert with .astype(\"<f4\")",
        ),
        ("int64", of_type("<i8"), "are int64; they must be float32"),
        ("bool", of_type("|b1"), "are of a type '|b1'; they must be float32"),
        ("objects", of_type("|O"), "are of a type '|O'"),
        ("Fortran order", fortran, "Fortran order; save np.ascontiguousarray(array)"),
        (
            "cut off",
            of_shape("(2, 3)", 23),
            "(2, 3) in float32 takes 24 bytes and the file has 23; it is cut off",
        ),
        ("two arrays", of_shape("(2, 3)", 28), "4 bytes follow an array of shape (2, 3) in float32"),
        ("huge", of_shape("(4611686018427387904, 3)", 24), "larger than any memory"),
        ("huge on one axis", of_shape("(4611686018427387904,)", 24), "larger than any memory"),
        ("too large for its file", of_shape("(1000000000000, 3)", 24), "it is cut off"),
    ] {
        let message = read::<f32>(&bytes).unwrap_err();
        assert!(message.contains(expected), "{what}: {message}");
    }
    for descr in ["<i4", "<i8", "<f4", "<u8"] {
        let message = read::<u32>(&of_type(descr)).unwrap_err();
        assert!(message.ends_with("must be uint32: convert with .astype(np.uint32)"), "{descr}: {message}");
    }
}

#[test]
fn an_axis_of_length_0_makes_any_shape_empty() {
    let huge = of_shape("(4611686018427387904, 4611686018427387904, 0)", 0);
    assert_eq!(read::<f32>(&huge).unwrap().values.len(), 0);
}
