//! Randomly damaged files: after deleting, swapping or inserting parts, a scenario is rejected with a printable message or
//! runs, and the program never panics.

use gyrolab::engine::analysis::cost;
use gyrolab::engine::export::COLUMNS;
use gyrolab::engine::run::{Sample, Simulation};
use gyrolab::engine::scenario::presets::{PRESETS, find};
use gyrolab::engine::scenario::{Document, Problems, Scenario};
use gyrolab::engine::text::printable::is_steering;
use gyrolab::physics::scheme;
use proptest::prelude::*;
use proptest::sample::Index;
use std::sync::Arc;

/// Text that extends a preset to a run file with everything a run file can contain. It needs a point "hub".
const MORE: &str = r#"
[[push]]
point = "hub"
force_N = [3, 2, 1]
from_s = 0.01
for_s = 0.05

[[edit]]
step = 5
set = { "motion.time_step_s" = 0.002, "motion.gravity_m_per_s2" = 1.6 }

[[edit]]
step = 9
set = { "push.0.force_N" = [0, 1, 2], "motion.scheme" = "report" }
"#;

/// Returns `preset` with [`MORE`], pushed at a point of its body.
fn with_more(preset: &str) -> String {
    let scenario = load(preset).unwrap();
    let hub = match scenario.body.point("hub") {
        Some(_) => "hub".to_owned(),
        None => scenario.body.names()[0].to_owned(),
    };
    preset.to_owned() + &MORE.replace("\"hub\"", &format!("\"{hub}\""))
}

/// One random damage to a file.
#[derive(Clone, Debug)]
enum Accident {
    Cut(Index, usize),
    Swap(Index, Index),
    Double(Index),
    Insert(Index, String),
    Number(Index, String),
    Word(Index, Index),
    Scheme(&'static str),
}

fn number() -> impl Strategy<Value = String> {
    let strange: Vec<_> =
        "0 -0.0 -1 1 2 1e308 -1e308 1e-308 5e-324 nan inf -inf 1e154 1e-154 1e100 \
        1e-100 100000 9223372036854775807 -9223372036854775808 9223372036854775808 0x10 1_000 \
        1e3 [] {} true \"text\""
            .split(' ')
            .collect();
    prop_oneof![
        prop::sample::select(strange).prop_map(str::to_owned),
        any::<f64>().prop_map(|number| format!("{number:?}")),
        any::<i64>().prop_map(|number| number.to_string()),
        (-9.0..9.0f64, -20..20).prop_map(|(digits, power)| format!("{digits}e{power}")),
        (0..1000u32).prop_map(|number| number.to_string()),
        (-10.0..10.0f64).prop_map(|number| number.to_string()),
    ]
}

fn accident() -> impl Strategy<Value = Accident> {
    prop_oneof![
        2 => (any::<Index>(), 1..40usize).prop_map(|(at, length)| Accident::Cut(at, length)),
        1 => any::<(Index, Index)>().prop_map(|(a, b)| Accident::Swap(a, b)),
        1 => any::<Index>().prop_map(Accident::Double),
        1 => (any::<Index>(), any::<String>()).prop_map(|(at, text)| Accident::Insert(at, text)),
        12 => (any::<Index>(), number()).prop_map(|(at, number)| Accident::Number(at, number)),
        1 => any::<(Index, Index)>().prop_map(|(a, b)| Accident::Word(a, b)),
        4 => prop::sample::select(scheme::names().to_vec()).prop_map(Accident::Scheme),
    ]
}

/// Returns the ranges of `text` that consist of characters for which `belongs` is true.
fn parts(text: &str, belongs: impl Fn(char) -> bool) -> Vec<(usize, usize)> {
    let mut parts: Vec<(usize, usize)> = Vec::new();
    for (at, c) in text.char_indices().filter(|&(_, c)| belongs(c)) {
        match parts.last_mut() {
            Some((_, end)) if *end == at => *end = at + c.len_utf8(),
            _ => parts.push((at, at + c.len_utf8())),
        }
    }
    parts
}

/// Returns the ranges of the numbers after `=` signs.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let all = parts(text, |c| c.is_ascii_alphanumeric() || ".-+_".contains(c));
    all.into_iter()
        .filter(|&(begin, end)| {
            let line = &text[..begin].rsplit('\n').next().unwrap_or_default();
            line.contains('=')
                && text[begin..end].starts_with(|c: char| c.is_ascii_digit() || c == '-')
        })
        .collect()
}

fn happen(text: &mut String, accident: &Accident) {
    let boundary = |at: &Index| {
        let mut at = at.index(text.len() + 1);
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let lines: Vec<_> = text.lines().collect();
    match accident {
        Accident::Cut(at, length) => {
            let begin = boundary(at);
            let mut end = (begin + length).min(text.len());
            while !text.is_char_boundary(end) {
                end += 1;
            }
            text.replace_range(begin..end, "");
        }
        Accident::Swap(a, b) if !lines.is_empty() => {
            let mut lines = lines;
            let (a, b) = (a.index(lines.len()), b.index(lines.len()));
            lines.swap(a, b);
            *text = lines.join("\n");
        }
        Accident::Double(at) if !lines.is_empty() => {
            let mut lines = lines;
            let at = at.index(lines.len());
            lines.insert(at, lines[at]);
            *text = lines.join("\n");
        }
        Accident::Insert(at, new) => {
            let at = boundary(at);
            text.insert_str(at, new);
        }
        Accident::Number(at, new) => {
            let all = numbers(text);
            if !all.is_empty() {
                let (begin, end) = *at.get(&all);
                text.replace_range(begin..end, new);
            }
        }
        Accident::Word(from, to) => {
            let all = parts(text, char::is_alphabetic);
            if !all.is_empty() {
                let word = text[from.get(&all).0..from.get(&all).1].to_owned();
                let (begin, end) = *to.get(&all);
                text.replace_range(begin..end, &word);
            }
        }
        Accident::Scheme(name) => {
            let key = |scheme_name: &str| format!("scheme = \"{scheme_name}\"");
            for known in scheme::names() {
                *text = text.replace(&key(known), &key(name));
            }
        }
        Accident::Swap(..) | Accident::Double(_) => {}
    }
}

fn mangled() -> impl Strategy<Value = String> {
    let preset = prop::sample::select(PRESETS).prop_map(|preset| preset.text);
    let text = prop_oneof![
        preset.clone().prop_map(str::to_owned),
        preset.prop_map(with_more)
    ];
    let accidents = prop::collection::vec(accident(), 1..5);
    (text, accidents).prop_map(|(mut text, accidents)| {
        for accident in &accidents {
            happen(&mut text, accident);
        }
        text
    })
}

fn load(text: &str) -> Result<Scenario, Problems> {
    Document::parse("mangled.toml", text).and_then(|document| document.scenario())
}

/// Returns the samples of the first steps, up to the last finite one. If every step integrates many turns, only as many
/// steps as take a few seconds are played.
fn first_samples(scenario: Scenario, steps: u64) -> Vec<Sample> {
    let rad_per_step = cost::integration_rad(&scenario) / scenario.steps as f64;
    let affordable = (cost::AFFORDABLE_RAD / rad_per_step) as u64;
    let edited = scenario.edits.iter().map(|edit| edit.motion);
    let mut motions = std::iter::once(scenario.motion).chain(edited);
    let is_integrated = motions.any(|motion| motion.scheme.name == "exact");
    let most = if is_integrated { affordable } else { steps };
    let end = scenario.steps.min(steps).min(most);
    let mut simulation = Simulation::new(Arc::new(scenario));
    let mut samples = vec![simulation.sample()];
    while simulation.step_number() < end && simulation.step().is_ok() {
        samples.push(simulation.sample());
    }
    samples
}

fn check_samples(scenario: &Scenario, samples: &[Sample]) -> Result<(), TestCaseError> {
    for sample in samples {
        for column in COLUMNS {
            let (step, name) = (sample.step, column.name);
            let number = column.value(scenario, sample);
            prop_assert!(number.is_finite(), "step {step}: {name} = {number}");
        }
    }
    Ok(())
}

fn check_refusal(problems: &Problems) -> Result<(), TestCaseError> {
    let message = problems.to_string();
    prop_assert!(!problems.list.is_empty());
    let is_full = message.lines().all(|line| !line.trim().is_empty());
    let is_steering = message.chars().any(|c| c != '\n' && is_steering(c));
    prop_assert!(is_full && !is_steering, "{message:?}");
    prop_assert!(message.contains("mangled.toml"), "{message:?}");
    Ok(())
}

/// Checks that a written scenario reads back to the same file and to the same run, bit for bit.
fn check_round_trip(scenario: &Scenario, samples: &[Sample]) -> Result<(), TestCaseError> {
    let text = scenario.to_toml();
    let again = match load(&text) {
        Ok(again) => again,
        Err(problems) => return Err(TestCaseError::fail(format!("{problems}\n{text}"))),
    };
    let mut file = scenario.file.clone();
    file.gyrolab.clone_from(&again.file.gyrolab);
    prop_assert_eq!(&again.file, &file);
    prop_assert_eq!(again.to_toml(), text);
    let steps = samples.len() as u64 - 1;
    prop_assert_eq!(
        bits(scenario, &first_samples(again, steps)),
        bits(scenario, samples)
    );
    Ok(())
}

fn bits(scenario: &Scenario, samples: &[Sample]) -> Vec<u64> {
    samples
        .iter()
        .flat_map(|sample| {
            let columns = COLUMNS.iter();
            columns.map(move |column| column.value(scenario, sample).to_bits())
        })
        .collect()
}

#[test]
fn every_preset_survives_a_round_trip() {
    for preset in PRESETS {
        for text in [preset.text.to_owned(), with_more(preset.text)] {
            let scenario = load(&text).unwrap_or_else(|problems| panic!("{problems}"));
            let samples = first_samples(scenario.clone(), 50);
            check_samples(&scenario, &samples).unwrap();
            check_round_trip(&scenario, &samples).unwrap();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_mangled_file_is_rejected_or_runs(text in mangled()) {
        match load(&text) {
            Err(problems) => check_refusal(&problems)?,
            Ok(scenario) => {
                let samples = first_samples(scenario.clone(), 300);
                check_samples(&scenario, &samples)?;
                check_round_trip(&scenario, &samples[..samples.len().min(20)])?;
            }
        }
    }

    #[test]
    fn any_text_is_rejected_or_valid(text in any::<String>()) {
        if let Err(problems) = load(&text) {
            check_refusal(&problems)?;
        }
    }

    #[test]
    fn any_setting_is_rejected_or_runs(
        keys in prop::collection::vec(prop_oneof![
            prop::sample::select(gyrolab::engine::scenario::keys::KEYS.iter().map(|key| key.path.replace('*', "0")).collect::<Vec<_>>()),
            "[a-z._0-9]{0,12}",
        ], 1..4),
        value in prop_oneof![number(), any::<String>(), prop::collection::vec(number(), 0..4).prop_map(|list| format!("[{}]", list.join(",")))],
    ) {
        let mut document = Document::parse("mangled.toml", &(find("wobble-push").unwrap().text.to_owned() + MORE)).unwrap();
        let set = keys.iter().try_for_each(|key| document.set(&format!("{key}={value}")));
        match set.and_then(|()| document.scenario()) {
            Err(problems) => check_refusal(&problems)?,
            Ok(scenario) => check_samples(&scenario, &first_samples(scenario.clone(), 50))?,
        }
    }
}
