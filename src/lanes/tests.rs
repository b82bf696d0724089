//! At every width an operation gives, lane by lane, the bits of the same operation on plain numbers.
//!
//! What is expected is written with the standard library's operators, so one lane is checked too.

use super::{Double, Job, Lanes, Mask, Single, Vector, Width};
use proptest::prelude::*;
use std::fmt::Debug;

/// As many numbers as the widest lanes hold; narrower lanes take them in turns.
const MOST: usize = 16;
type Row<T> = [T; MOST];

/// A number whose bits can be compared, one NaN being like any other.
trait Number: Copy + Debug + PartialOrd + Default {
    fn same(self, other: Self) -> bool;
}

impl Number for f32 {
    fn same(self, other: Self) -> bool {
        self.to_bits() == other.to_bits() || (self.is_nan() && other.is_nan())
    }
}

impl Number for f64 {
    fn same(self, other: Self) -> bool {
        self.to_bits() == other.to_bits() || (self.is_nan() && other.is_nan())
    }
}

impl Number for u32 {
    fn same(self, other: Self) -> bool {
        self == other
    }
}

/// Lanes of the widest row against what each must be.
fn assert_row<T: Number>(what: &str, width: usize, found: &Row<T>, expected: impl Fn(usize) -> T) {
    for (lane, &found) in found.iter().enumerate() {
        let expected = expected(lane);
        assert!(found.same(expected), "{what} at width {width}, lane {lane}: {found:?}, not {expected:?}");
    }
}

/// Runs an operation over a row, as many lanes at a time as there are.
fn over_row<T: Number>(width: usize, mut store: impl FnMut(usize, &mut [T])) -> Row<T> {
    let mut row = [T::default(); MOST];
    for first in (0..MOST).step_by(width) {
        store(first, &mut row[first..first + width]);
    }
    row
}

fn mask_over_row(width: usize, mask: impl Fn(usize) -> u32) -> Row<u32> {
    over_row(width, |first, to| {
        let bits = mask(first);
        assert_eq!(bits >> width, 0, "bits beyond the lanes at width {width}");
        for (lane, to) in to.iter_mut().enumerate() {
            *to = bits >> lane & 1;
        }
    })
}

type One<T> = fn(T) -> T;
type Two<T> = fn(T, T) -> T;
type Truth<T> = fn(&T, &T) -> bool;
type Compare<L> = fn(L, L) -> <L as Lanes>::Mask;
/// What it is called, how lanes do it, and how plain numbers do.
type Named<L, P> = (&'static str, L, P);

/// What every kind of lanes has. The scalar's own operations come as plain functions.
fn check_lanes<L: Lanes<Scalar: Number>>(rows: [&Row<L::Scalar>; 3], scalar: &Plain<L::Scalar>) {
    let width = L::WIDTH;
    let [a, b, c] = rows;
    let load = |row: &Row<L::Scalar>, first: usize| L::load(&row[first..]);

    let two: [Named<Two<L>, Two<L::Scalar>>; 6] = [
        ("+", |a, b| a + b, scalar.add),
        ("-", |a, b| a - b, scalar.subtract),
        ("*", |a, b| a * b, scalar.multiply),
        ("/", |a, b| a / b, scalar.divide),
        ("min", L::min, |a, b| if a < b { a } else { b }),
        ("max", L::max, |a, b| if a > b { a } else { b }),
    ];
    for (what, lanes, plain) in two {
        let found = over_row(width, |first, to| lanes(load(a, first), load(b, first)).store(to));
        assert_row(what, width, &found, |lane| plain(a[lane], b[lane]));
    }

    let one: [Named<One<L>, One<L::Scalar>>; 3] =
        [("neg", |a| -a, scalar.negate), ("sqrt", L::sqrt, scalar.sqrt), ("abs", L::abs, scalar.abs)];
    for (what, lanes, plain) in one {
        let found = over_row(width, |first, to| lanes(load(a, first)).store(to));
        assert_row(what, width, &found, |lane| plain(a[lane]));
    }

    let truths: [Named<Compare<L>, Truth<L::Scalar>>; 5] = [
        ("lt", L::lt, PartialOrd::lt),
        ("le", L::le, PartialOrd::le),
        ("gt", L::gt, PartialOrd::gt),
        ("ge", L::ge, PartialOrd::ge),
        ("eq", L::eq, PartialEq::eq),
    ];
    for (what, lanes, plain) in truths {
        let found = mask_over_row(width, |first| lanes(load(a, first), load(b, first)).bits());
        assert_row(what, width, &found, |lane| u32::from(plain(&a[lane], &b[lane])));
        // Selecting by it picks whole numbers, whatever they are.
        let found = over_row(width, |first, to| {
            let mask = lanes(load(a, first), load(b, first));
            L::select(mask, load(c, first), load(b, first)).store(to);
        });
        assert_row(what, width, &found, |lane| if plain(&a[lane], &b[lane]) { c[lane] } else { b[lane] });
    }

    let masks: [Named<Two<L::Mask>, Two<bool>>; 5] = [
        ("and", |p, q| p & q, |p, q| p && q),
        ("or", |p, q| p | q, |p, q| p || q),
        ("^", |p, q| p ^ q, |p, q| p != q),
        ("xor", Mask::xor, |p, q| p != q),
        ("not", |p, _| !p, |p, _| !p),
    ];
    for (what, lanes, plain) in masks {
        let mask = |first| lanes(load(a, first).lt(load(b, first)), load(b, first).le(load(c, first)));
        let expected = |lane: usize| u32::from(plain(a[lane] < b[lane], b[lane] <= c[lane]));
        assert_row(what, width, &mask_over_row(width, |first| mask(first).bits()), expected);
        for first in (0..MOST).step_by(width) {
            let any = (first..first + width).any(|lane| expected(lane) == 1);
            assert_eq!(mask(first).any(), any, "any of {what} at width {width}");
        }
    }

    let found = over_row(width, |first, to| L::splat(a[first]).store(to));
    assert_row("splat", width, &found, |lane| a[lane / width * width]);
    check_vectors::<L>(rows, scalar);
}

/// Vectors are made of these operations in one order, which a plain number has too.
fn check_vectors<L: Lanes<Scalar: Number>>(rows: [&Row<L::Scalar>; 3], scalar: &Plain<L::Scalar>) {
    let width = L::WIDTH;
    // y and z come from other lanes of the same rows.
    let turned = |row: &Row<L::Scalar>, by: usize| -> Row<L::Scalar> {
        std::array::from_fn(|lane| row[(lane + by) % MOST])
    };
    let columns = [rows[0], rows[1]].map(|row| [*row, turned(row, 5), turned(row, 11)]);
    let vector = |of: usize, first: usize| {
        let [x, y, z] = [0, 1, 2].map(|axis| L::load(&columns[of][axis][first..]));
        Vector::new(x, y, z)
    };
    let plain = |of: usize, lane: usize| [0, 1, 2].map(|axis| columns[of][axis][lane]);
    let dot = |a: [L::Scalar; 3], b: [L::Scalar; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| (scalar.multiply)(a[axis], b[axis]));
        (scalar.add)((scalar.add)(x, y), z)
    };

    let found = over_row(width, |first, to| vector(0, first).dot(vector(1, first)).store(to));
    assert_row("dot", width, &found, |lane| dot(plain(0, lane), plain(1, lane)));
    let found = over_row(width, |first, to| vector(0, first).length().store(to));
    assert_row("length", width, &found, |lane| (scalar.sqrt)(dot(plain(0, lane), plain(0, lane))));
    for axis in 0..3 {
        let component = |vector: Vector<L>| [vector.x, vector.y, vector.z][axis];
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let found =
            over_row(width, |first, to| component(vector(0, first).cross(vector(1, first))).store(to));
        assert_row("cross", width, &found, |lane| {
            let (a, b) = (plain(0, lane), plain(1, lane));
            (scalar.subtract)((scalar.multiply)(a[next], b[last]), (scalar.multiply)(a[last], b[next]))
        });
        let one = (scalar.divide)(scalar.two, scalar.two);
        let found =
            over_row(width, |first, to| component(vector(0, first).normalized(L::splat(one))).store(to));
        assert_row("normalized", width, &found, |lane| {
            let a = plain(0, lane);
            (scalar.multiply)(a[axis], (scalar.divide)(one, (scalar.sqrt)(dot(a, a))))
        });
        let found = over_row(width, |first, to| {
            let (a, b) = (vector(0, first), vector(1, first));
            component(Vector::select(a.x.lt(b.x), -a, b.times(a + b) - a)).store(to);
        });
        assert_row("select, times, + and - of vectors", width, &found, |lane| {
            let (a, b) = (plain(0, lane), plain(1, lane));
            let sum = (scalar.add)(a[axis], b[axis]);
            let otherwise = (scalar.subtract)((scalar.multiply)(b[axis], sum), a[axis]);
            if a[0] < b[0] { (scalar.negate)(a[axis]) } else { otherwise }
        });
    }
}

/// The standard library's operations on plain numbers.
struct Plain<T> {
    add: fn(T, T) -> T,
    subtract: fn(T, T) -> T,
    multiply: fn(T, T) -> T,
    divide: fn(T, T) -> T,
    negate: fn(T) -> T,
    sqrt: fn(T) -> T,
    abs: fn(T) -> T,
    two: T,
}

macro_rules! plain {
    ($scalar:ty) => {
        Plain {
            add: |a: $scalar, b| a + b,
            subtract: |a, b| a - b,
            multiply: |a, b| a * b,
            divide: |a, b| a / b,
            negate: |a| -a,
            sqrt: <$scalar>::sqrt,
            abs: <$scalar>::abs,
            two: 2.0,
        }
    };
}

/// Numbers of both precisions through the operations of one width and of the f64 lanes that go with it.
struct Numbers<'a> {
    single: [&'a Row<f32>; 3],
    double: [&'a Row<f64>; 3],
}

impl Job for Numbers<'_> {
    type Output = ();

    fn run<F: Single>(self) {
        check_lanes::<F>(self.single, &plain!(f32));
        check_lanes::<F::Double>(self.double, &plain!(f64));

        let width = F::Double::WIDTH;
        let (narrow, wide) = (self.single[0], self.double[0]);
        let found = over_row(width, |first, to| F::Double::widen(&narrow[first..]).store(to));
        assert_row("widen", width, &found, |lane| f64::from(narrow[lane]));
        let found = over_row(width, |first, to| F::Double::load(&wide[first..]).round(to));
        #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
        assert_row("round", width, &found, |lane| wide[lane] as f32);
    }
}

/// Positive normal numbers, and whole numbers from −1022 to 1023.
struct Exponents<'a> {
    numbers: &'a Row<f64>,
    powers: &'a Row<i16>,
}

impl Job for Exponents<'_> {
    type Output = ();

    fn run<F: Single>(self) {
        let width = F::Double::WIDTH;
        let split = |first: usize| F::Double::load(&self.numbers[first..]).split_exponent();
        let exponents = over_row(width, |first, to| split(first).0.store(to));
        let mantissas = over_row(width, |first, to| split(first).1.store(to));
        for (lane, &number) in self.numbers.iter().enumerate() {
            let (exponent, mantissa) = (exponents[lane], mantissas[lane]);
            assert!((1.0..2.0).contains(&mantissa), "mantissa {mantissa} of {number:e} at width {width}");
            assert_eq!(exponent, exponent.round(), "exponent of {number:e} at width {width}");
            assert_eq!(mantissa * power_of_two(exponent), number, "2^{exponent} at width {width}");
        }
        let powers = self.powers.map(f64::from);
        for factor in [&mantissas, self.numbers] {
            let found = over_row(width, |first, to| {
                F::Double::load(&factor[first..])
                    .times_power_of_two(F::Double::load(&powers[first..]))
                    .store(to);
            });
            assert_row("times_power_of_two", width, &found, |lane| factor[lane] * power_of_two(powers[lane]));
        }
    }
}

/// By doubling and halving, which are exact down to the smallest normal number.
fn power_of_two(exponent: f64) -> f64 {
    let step = if exponent < 0.0 { 0.5 } else { 2.0 };
    std::iter::successors(Some((1.0, 0.0)), |&(power, done)| Some((power * step, done + 1.0)))
        .find_map(|(power, done)| (done == exponent.abs()).then_some(power))
        .unwrap_or(f64::NAN)
}

/// Ids below 2³¹ or `u32::MAX`, and words that may be anything.
struct Ids<'a> {
    a: &'a Row<u32>,
    b: &'a Row<u32>,
    word: &'a Row<u32>,
    other: &'a Row<u32>,
}

impl Job for Ids<'_> {
    type Output = ();

    fn run<F: Single>(self) {
        let width = F::WIDTH;
        let Self { a, b, word, other } = self;
        let load = |row: &Row<u32>, first: usize| F::load_ids(&row[first..]);

        let found = mask_over_row(width, |first| F::ids_eq(load(word, first), load(other, first)).bits());
        assert_row("ids_eq", width, &found, |lane| u32::from(word[lane] == other[lane]));
        let found = mask_over_row(width, |first| F::ids_odd(load(word, first)).bits());
        assert_row("ids_odd", width, &found, |lane| word[lane] % 2);
        let found = mask_over_row(width, |first| F::of_bits(word[0] >> first).bits());
        assert_row("of_bits", width, &found, |lane| word[0] >> lane & 1);
        let found = over_row(width, |first, to| F::store_ids(F::ids_half(load(word, first)), to));
        assert_row("ids_half", width, &found, |lane| word[lane] / 2);
        let found = over_row(width, |first, to| F::store_ids(F::splat_ids(word[first]), to));
        assert_row("splat_ids", width, &found, |lane| word[lane / width * width]);
        // A mask of ids chooses ids, and it chooses numbers.
        let numbers = [a, b].map(|ids| ids.map(f32::from_bits));
        let found = over_row(width, |first, to| {
            let mask = F::ids_eq(load(word, first), load(other, first));
            F::store_ids(F::select_ids(mask, load(a, first), load(b, first)), to);
        });
        assert_row(
            "select_ids",
            width,
            &found,
            |lane| if word[lane] == other[lane] { a[lane] } else { b[lane] },
        );
        let found = over_row(width, |first, to| {
            let mask = F::ids_odd(load(word, first)) & !F::first(0);
            F::select(mask, F::load(&numbers[0][first..]), F::load(&numbers[1][first..])).store(to);
        });
        assert_row("select by ids", width, &found, |lane| numbers[usize::from(word[lane] % 2 == 0)][lane]);
    }
}

struct FirstLanes;

impl Job for FirstLanes {
    type Output = ();

    fn run<F: Single>(self) {
        fn check<L: Lanes>() {
            for count in 0..=2 * L::WIDTH {
                let expected = (0..L::WIDTH).map(|lane| u32::from(lane < count) << lane).sum::<u32>();
                let mask = L::first(count);
                assert_eq!(mask.bits(), expected, "first {count} of {}", L::WIDTH);
                assert_eq!(mask.any(), count > 0, "any of the first {count} of {}", L::WIDTH);
                // Bits alone would not show a mask that is neither all ones nor all zeros in a lane.
                assert_eq!((!mask).bits(), !expected & ((1 << L::WIDTH) - 1), "not the first {count}");
            }
            assert_eq!(L::first(usize::MAX).bits(), L::first(L::WIDTH).bits(), "of {}", L::WIDTH);
        }
        check::<F>();
        check::<F::Double>();
        check::<F::Block>();
        check::<F::Node>();
    }
}

/// Widths of the types that go with F.
struct Widths;

impl Job for Widths {
    type Output = [usize; 4];

    fn run<F: Single>(self) -> [usize; 4] {
        [F::WIDTH, F::Double::WIDTH, F::Block::WIDTH, F::Node::WIDTH]
    }
}

struct Slices;

impl Job for Slices {
    type Output = ();

    fn run<F: Single>(self) {
        let from: [f32; MOST + 1] = std::array::from_fn(|lane| lane as f32 + 1.0);
        let mut to = [0.0; MOST + 1];
        F::load(&from).store(&mut to);
        let mut ids = [0; MOST + 1];
        F::store_ids(F::load_ids(&from.map(f32::to_bits)), &mut ids);
        let mut rounded = [0.0; MOST + 1];
        F::Double::widen(&from).round(&mut rounded);
        for lane in 0..=MOST {
            let if_within = |width: usize| if lane < width { from[lane] } else { 0.0 };
            assert_eq!(to[lane], if_within(F::WIDTH), "lane {lane} of {}", F::WIDTH);
            assert_eq!(ids[lane], if_within(F::WIDTH).to_bits(), "id {lane} of {}", F::WIDTH);
            assert_eq!(rounded[lane], if_within(F::Double::WIDTH), "rounded {lane} of {}", F::Double::WIDTH);
        }
    }
}

/// The numbers between which lanes could differ, beside any pattern of bits.
fn single() -> impl Strategy<Value = f32> {
    const SPECIAL: [f32; 12] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
        f32::MAX,
        f32::MIN_POSITIVE,
        f32::from_bits(1),
        -f32::from_bits(1),
        16_777_216.0,
    ];
    prop_oneof![
        2 => any::<u32>().prop_map(f32::from_bits),
        2 => prop::sample::select(&SPECIAL[..]),
        1 => -4.0..4.0_f32,
    ]
}

fn double() -> impl Strategy<Value = f64> {
    const SPECIAL: [f64; 12] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        f64::MAX,
        f64::MIN_POSITIVE,
        f64::from_bits(1),
        3.402_823_5e38,
        1e-45,
    ];
    prop_oneof![
        2 => any::<u64>().prop_map(f64::from_bits),
        2 => prop::sample::select(&SPECIAL[..]),
        // Half-way between two f32, and next to it.
        1 => (any::<i16>(), 0..3_i64).prop_map(|(m, off)| {
            let half_way = f64::from(m) + f64::from(m.signum()) / f64::from(1 << 12);
            f64::from_bits(half_way.to_bits().wrapping_add_signed(off - 1))
        }),
        1 => -4.0..4.0_f64,
    ]
}

fn positive_normal() -> impl Strategy<Value = f64> {
    let ends = [f64::MIN_POSITIVE, f64::MAX, 1.0, 1.0_f64.next_down(), 2.0_f64.next_down(), 2.0];
    let any = (f64::MIN_POSITIVE.to_bits()..=f64::MAX.to_bits()).prop_map(f64::from_bits);
    prop_oneof![4 => any, 1 => prop::sample::select(ends.to_vec())]
}

fn id() -> impl Strategy<Value = u32> {
    prop_oneof![4 => 0..4_u32, 2 => 0..1_u32 << 31, 1 => Just((1 << 31) - 1), 2 => Just(u32::MAX)]
}

fn word() -> impl Strategy<Value = u32> {
    prop_oneof![3 => 0..4_u32, 2 => any::<u32>(), 1 => Just(u32::MAX)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn numbers_have_the_same_bits_at_every_width(
        single in prop::array::uniform3(prop::array::uniform16(single())),
        double in prop::array::uniform3(prop::array::uniform16(double())),
    ) {
        for width in Width::ALL {
            width.run(Numbers { single: single.each_ref(), double: double.each_ref() });
        }
    }

    #[test]
    fn exponents_come_apart_and_together_at_every_width(
        numbers in prop::array::uniform16(positive_normal()),
        powers in prop::array::uniform16(prop_oneof![4 => -1022..=1023_i16, 1 => Just(-1022), 1 => Just(1023)]),
    ) {
        for width in Width::ALL {
            width.run(Exponents { numbers: &numbers, powers: &powers });
        }
    }

    #[test]
    fn ids_compare_and_select_alike_at_every_width(
        a in prop::array::uniform16(id()),
        b in prop::array::uniform16(id()),
        word in prop::array::uniform16(word()),
        other in prop::array::uniform16(word()),
    ) {
        for width in Width::ALL {
            width.run(Ids { a: &a, b: &b, word: &word, other: &other });
        }
    }
}

#[test]
fn the_first_lanes_are_as_many_as_asked_for() {
    for width in Width::ALL {
        width.run(FirstLanes);
    }
}

#[test]
fn widths_are_what_their_names_say() {
    let found = Width::ALL.map(|width| (width.lanes(), width.run(Widths)));
    let expected = [(1, [1, 1, 1, 1]), (4, [4, 2, 4, 4]), (8, [8, 4, 4, 8]), (16, [16, 8, 4, 8])];
    assert_eq!(found, expected);
}

#[test]
fn slices_are_read_and_written_no_further_than_the_lanes_go() {
    for width in Width::ALL {
        width.run(Slices);
    }
}
