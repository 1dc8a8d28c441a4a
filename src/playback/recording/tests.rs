use super::level::WHOLE;
use super::*;
use proptest::prelude::*;

fn push(recording: &mut Recording, step: u64, value: f64) {
    recording.push_values(step as f64, [value, 0.0, 0.0, -value]);
}

fn recorded(values: &[f64]) -> Recording {
    let mut recording = Recording::default();
    let values = values.iter().zip(0..);
    values.for_each(|(&value, step)| push(&mut recording, step, value));
    recording
}

/// Checks that `blocks` begin at `since` or before, and follow each other without a gap; the end of the last one.
fn end_of(blocks: &[Block], since: f64) -> f64 {
    assert!(blocks[0].begin_s <= since);
    for pair in blocks.windows(2) {
        assert_eq!(pair[0].end_s + 1.0, pair[1].begin_s);
    }
    blocks[blocks.len() - 1].end_s
}

proptest! {
    #[test]
    fn every_step_is_in_exactly_one_block_of_a_stretch(length in 1usize..20_000, share in 0.0..1.0f64) {
        let recording = recorded(&vec![0.0; length]);
        let since = (share * length as f64).floor();
        let blocks: Vec<_> = recording.since(since).collect();
        prop_assert_eq!(end_of(&blocks, since), (length - 1) as f64);
        prop_assert!(blocks.len() <= 4 * FINEST as usize + 16);
    }

    #[test]
    fn columns_have_the_same_moments_in_fewer_blocks(
        length in 1usize..40_000, columns in 1usize..300, ends in (0.0..1.0f64, 0.0..1.2f64)
    ) {
        let values: Vec<f64> = (0..length).map(|step| (step as f64 * 0.37).sin()).collect();
        let recording = recorded(&values);
        let [since, until] = [ends.0, ends.1].map(|share| (share * length as f64).floor());
        let column = |time_s: f64| (time_s / length as f64 * columns as f64) as usize;
        let single: Vec<_> = recording.between(since, until).collect();
        let joined: Vec<_> = recording.in_columns(since, until, Some(column)).collect();
        let is_inside = |block: &Block| column(block.begin_s) == column(block.end_s);
        let mut rest = single.iter();
        for block in &joined {
            let parts: Vec<_> = rest.by_ref().take_while(|part| part.end_s < block.end_s).collect();
            // take_while() has taken the last part too.
            prop_assert!(parts.first().is_none_or(|part| part.begin_s == block.begin_s));
            prop_assert!(parts.is_empty() || is_inside(block));
        }
        prop_assert_eq!(rest.count(), 0);
        let moments = |blocks: &[Block]| blocks.iter().map(Block::moments).sum::<u64>();
        prop_assert_eq!(moments(&single), moments(&joined));
        // The first and the last of every column are the same, so that lines from column to column are.
        for pair in joined.windows(2).filter(|pair| column(pair[0].end_s) != column(pair[1].begin_s)) {
            prop_assert!(single.contains(&pair[0]) && single.contains(&pair[1]));
        }
        let most = single.len().min(columns.min(single.len()) * 26 + 16);
        prop_assert!(joined.len() <= most, "{} of {} in {columns}", joined.len(), single.len());
        let extent = single.iter().map(|block| block.extent(Curve::X)).reduce(Extent::and);
        prop_assert_eq!(recording.extent_between(since, until, Curve::X), extent);
    }

    #[test]
    fn no_extreme_is_lost(at in 0usize..9_000, length in 9_000usize..10_000) {
        let mut values = vec![0.0; length];
        values[at] = 7.0;
        let recording = recorded(&values);
        let largest = recording.since(0.0).map(|block| block.extents[0].max).fold(0.0, f64::max);
        prop_assert_eq!(largest, 7.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn cut_back_and_filled_it_is_as_fine_as_ever(
        length in 1u64..200_000, shares in prop::collection::vec(0.0..1.0f64, 1..4), at in 0.0..1.0f64
    ) {
        let value = |step: u64| if step == (at * length as f64) as u64 { 7.0 } else { (step as f64 * 0.01).sin() };
        let mut recording = Recording::default();
        (0..length).for_each(|step| push(&mut recording, step, value(step)));
        prop_assert_eq!(recording.coarse_since(), None);
        for share in shares {
            let wanted = 1 + (share * (length - 1) as f64) as u64;
            let mut kept = recording.cut_back(wanted);
            prop_assert!(kept <= wanted);
            if let Some(from) = recording.coarse_since() {
                prop_assert!(wanted - from <= length / 8, "{} of {}", wanted - from, length);
                kept = recording.cut_back(from);
            }
            (kept..wanted).for_each(|step| push(&mut recording, step, value(step)));
            prop_assert_eq!(recording.moments(), wanted);
            prop_assert_eq!(recording.coarse_since(), None);
            for since in [0.0, 0.4, 0.9, 0.999] {
                let since = (since * wanted as f64).floor();
                let blocks: Vec<_> = recording.since(since).collect();
                prop_assert_eq!(end_of(&blocks, since), (wanted - 1) as f64);
                let (blocks, steps) = (blocks.len() as f64, wanted as f64 - since);
                prop_assert!(blocks >= steps.min(0.45 * COARSE as f64), "{blocks} since {since} of {wanted}");
            }
            let largest = (0..wanted).map(value).fold(-1.0, f64::max);
            prop_assert_eq!(recording.whole().unwrap().extents[0].max, largest);
            (wanted..length).for_each(|step| push(&mut recording, step, value(step)));
            let blocks: Vec<_> = recording.since(0.0).collect();
            prop_assert_eq!(end_of(&blocks, 0.0), (recording.moments() - 1) as f64);
        }
    }
}

#[test]
fn a_block_knows_how_often_the_curve_turns() {
    let turns = |recording: &Recording| recording.whole().unwrap().turns(Curve::X);
    // Ten swings of a triangle about 5, from 0 to 10 and back in 20 steps each.
    let triangle = |step: u64| (10.0 - (step % 20) as f64).abs();
    let values: Vec<f64> = (0..=200).map(triangle).collect();
    let recording = recorded(&values);
    assert_eq!(recording.whole().unwrap().moments(), 201);
    assert_eq!(turns(&recording), 19);
    let blocks = recording.since(0.0).map(|block| block.turns(Curve::X));
    assert_eq!(blocks.sum::<u32>(), 19);
    // It stands still, and goes on in the same direction: no turn.
    assert_eq!(turns(&recorded(&[0.0, 1.0, 1.0, 2.0, 2.0, 1.0])), 1);
}

#[test]
fn a_stretch_long_ago_has_more_blocks_than_a_part_of_all() {
    let values: Vec<f64> = (0..100_000).map(f64::from).collect();
    let recording = recorded(&values);
    let blocks: Vec<_> = recording.between(10_000.0, 11_000.0).collect();
    assert!(end_of(&blocks, 10_000.0) >= 11_000.0);
    assert!((100..200).contains(&blocks.len()), "{}", blocks.len());
}

#[test]
fn memory_is_bounded() {
    let recording = recorded(&vec![0.0; 1_000_000]);
    let stored = |level: &Level| level.count() - level.dropped();
    let stored: Vec<u64> = recording.levels.iter().map(stored).collect();
    assert_eq!(stored[0], 4096);
    let larger: u64 = stored[1..].iter().sum();
    assert!(larger <= 2048 * 8 + 2 * WHOLE as u64, "{larger} blocks");
    // The smallest that there are cover the run without a gap.
    let blocks: Vec<_> = recording.finest().collect();
    assert_eq!(end_of(&blocks, 0.0), 999_999.0);
    let newest = &blocks[blocks.len() - 4000..];
    assert!(newest.iter().all(|block| block.moments() == 1));
}
