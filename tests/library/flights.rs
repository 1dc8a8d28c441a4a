//! Detection of free flights in recordings of a thrown and caught gyroscope sensor.

use crate::support::dice::Dice;
use crate::support::scenarios::preset;
use gyrolab::engine::data::{DataKind, TimeSeries, at_times, read};
use gyrolab::studies::fit::flights::{Flight, Found, find};
use std::fmt::Write;
use std::sync::Arc;

const RATE: f64 = 200.0;
const NOISE: f64 = 0.02;

fn series(text: &str) -> TimeSeries {
    match read("recording.csv", text).unwrap().data {
        DataKind::Series(series) => series,
        DataKind::Table(_) => panic!("no series"),
    }
}

/// Returns the rates of the preset's phone in free flight with the initial angular velocity `omega`.
fn flight(omega: [f64; 3], seconds: f64) -> Vec<[f64; 3]> {
    let rows = (seconds * RATE) as u32;
    let lines = (0..rows).map(|row| format!("{},0,0,0\n", f64::from(row) / RATE));
    let head = "t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s\n".to_owned();
    let series = series(&(head + &lines.collect::<String>()));
    let thrown = preset(
        "thrown-phone",
        &[&format!("start.omega_rad_per_s={omega:?}")],
    );
    let values = at_times(&series, &Arc::new(thrown), &|| true)
        .unwrap()
        .unwrap();
    (0..rows as usize)
        .map(|row| [0, 1, 2].map(|axis| values[axis][row]))
        .collect()
}

/// Returns rates of a hand motion from `from` to `to`.
fn by_hand(from: [f64; 3], to: [f64; 3], seconds: f64) -> Vec<[f64; 3]> {
    let rows = (seconds * RATE) as u32;
    (0..rows)
        .map(|row: u32| {
            let part = f64::from(row) / f64::from(rows);
            let part = part * part * (3.0 - 2.0 * part);
            [0, 1, 2].map(|axis| from[axis] + part * (to[axis] - from[axis]))
        })
        .collect()
}

/// Returns a recording of throws with the given rates, and the start and end of each flight, s. The hand waves before each.
fn recording(throws: &[[f64; 3]], seed: u64) -> (String, Vec<(f64, f64)>) {
    const REST: [f64; 3] = [0.0; 3];
    let (mut rates, mut flights) = (by_hand(REST, REST, 0.5), Vec::new());
    for &omega in throws {
        for peak in [[6.0, 0.5, -1.0], [-5.0, 2.0, 0.3]] {
            rates.extend(by_hand(REST, peak, 0.5));
            rates.extend(by_hand(peak, REST, 0.5));
        }
        rates.extend(by_hand(REST, omega, 0.2));
        let flown = flight(omega, 0.5);
        let begin = rates.len() as f64 / RATE;
        rates.extend(&flown);
        flights.push((begin, rates.len() as f64 / RATE));
        rates.extend(by_hand(flown[flown.len() - 1], REST, 0.1));
        rates.extend(by_hand(REST, REST, 0.3));
    }
    let mut dice = Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let mut noise = || NOISE * ((0..12).map(|_| dice.unit()).sum::<f64>() - 6.0);
    let mut text = "t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s\n".to_owned();
    for (row, row_rates) in rates.iter().enumerate() {
        let [a, b, c] = row_rates.map(|rate| rate + noise());
        writeln!(text, "{},{a},{b},{c}", row as f64 / RATE).unwrap();
    }
    (text, flights)
}

fn found(text: &str) -> Found {
    find(&series(text), &preset("thrown-phone", &[]))
}

#[test]
fn flights_are_found_without_the_hand_motion() {
    let throws = [[8.0, 0.8, 0.6], [1.0, -7.0, 2.0], [-0.5, 1.0, 12.0]];
    for seed in 1..=5 {
        for count in 1..=throws.len() {
            let (text, flown) = recording(&throws[..count], seed);
            let Found::Flights(flights) = found(&text) else {
                panic!("no flights")
            };
            assert_eq!(flights.len(), count, "seed {seed}: {flights:?}");
            for (Flight { from_s, to_s, .. }, (begin, end)) in flights.iter().zip(flown) {
                // The noise hides the push of the last 5 ms of a throw.
                let is_inside = *from_s >= begin - 0.005 && *to_s <= end + 0.005;
                let is_most = to_s - from_s > 0.85 * (end - begin);
                assert!(
                    is_inside && is_most,
                    "seed {seed}: {from_s}..{to_s} of {begin}..{end}"
                );
            }
        }
    }
}

#[test]
fn a_waving_hand_is_not_a_flight() {
    for seed in 1..=5 {
        let (text, flown) = recording(&[[8.0, 0.8, 0.6]], seed);
        let until = (flown[0].0 - 0.25) * RATE;
        let text: Vec<&str> = text.lines().take(until as usize).collect();
        assert_eq!(
            found(&text.join("\n")),
            Found::Flights(Vec::new()),
            "seed {seed}"
        );
    }
}

#[test]
fn a_recording_of_one_flight_is_used_whole_and_other_data_are_skipped() {
    let rows = flight([8.0, 0.8, 0.6], 0.6);
    let mut text = "t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s\n".to_owned();
    for (row, [a, b, c]) in rows.iter().enumerate() {
        writeln!(text, "{},{a},{b},{c}", row as f64 / RATE).unwrap();
    }
    assert_eq!(found(&text), Found::Whole);
    assert_eq!(found("t_s,tilt_deg\n0,1\n1,2\n"), Found::NotThrown);
    let heavy = preset("thrown-phone", &["motion.gravity_m_per_s2=9.81"]);
    assert_eq!(find(&series(&text), &heavy), Found::NotThrown);
}

#[test]
fn malformed_recordings_have_no_flights() {
    let head = "t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s\n";
    for rows in [
        "0,1,2,3\n",
        "0,1e200,2,3\n1,-1e200,5,5\n",
        "0,,2,3\n1,1,,3\n",
        "0,9,9,9\n0,9,9,9\n",
    ] {
        let found = found(&format!("{head}{rows}"));
        assert!(
            matches!(found, Found::Whole | Found::NotThrown),
            "{rows}: {found:?}"
        );
    }
    let huge = (0..100).map(|row| format!("{row},{}e150,1e150,-1e150\n", row % 7));
    found(&format!("{head}{}", huge.collect::<String>()));
}
