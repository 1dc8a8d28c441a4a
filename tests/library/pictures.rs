//! Pictures of single panes: the previous run, pushes, edits and forms.

use crate::support::scenarios::view as seen;
use gyrolab::engine::scenario::{Document, presets};
use gyrolab::lab::action::FieldEdit;
use gyrolab::lab::form::{InputField, InputForm};
use gyrolab::lab::playback::ghost::Ghost;
use gyrolab::lab::playback::live::LiveRun;
use gyrolab::lab::playback::pace::Pace;
use gyrolab::lab::playback::reading::Reading;
use gyrolab::lab::view::View;
use gyrolab::lab::view::theme::Marker;
use gyrolab::lab::view::theme::{Background, Palette, Theme};
use gyrolab::tui::panes::PlotInputs;
use gyrolab::tui::panes::form::FormPane;
use gyrolab::tui::panes::from_above::FromAbove;
use gyrolab::tui::panes::three_d::ThreeD;
use gyrolab::tui::panes::traces::Traces;
use proptest::prelude::*;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::sync::Arc;

const COLOURS: Theme = Theme {
    palette: Palette::TrueColor,
    background: Background::Dark,
};

/// Plays a preset for `steps`. `set` changes its keys, and `more` is appended to its file.
fn run(preset: &str, set: &[&str], more: &str, steps: u64) -> LiveRun {
    let text = presets::find(preset).unwrap().text;
    let mut document = Document::parse("test.toml", &format!("{text}\n{more}")).unwrap();
    set.iter().for_each(|set| document.set(set).unwrap());
    let mut run = LiveRun::new(Arc::new(document.scenario().unwrap()));
    (0..steps).for_each(|_| run.step().unwrap());
    run
}

fn view(run: &LiveRun, marker: Marker) -> View {
    seen(run.scenario(), marker, true)
}

fn drawn(widget: impl Widget, (width, height): (u16, u16)) -> String {
    let mut buf = Buffer::empty(Rect::new(0, 0, width, height));
    widget.render(buf.area, &mut buf);
    text(&buf)
}

/// Returns the cells of the buffer as text, one line per row.
fn text(buf: &Buffer) -> String {
    let lines = buf.content.chunks(buf.area.width.into());
    lines
        .map(|cells| {
            cells
                .iter()
                .map(Cell::symbol)
                .collect::<String>()
                .trim_end()
                .to_owned()
                + "\n"
        })
        .collect()
}

/// Plot inputs with only `run`.
fn seen_alone<'a>(run: &'a LiveRun, view: &'a View) -> PlotInputs<'a> {
    PlotInputs {
        view,
        run,
        ghost: None,
        pinned: None,
        measured: None,
        column: None,
        reading: None,
        explained: None,
        cursor: None,
    }
}

const EDITS: &str = "[[edit]]\nstep = 150\nset = { 'motion.time_step_s' = 0.05 }\n\
                     [[edit]]\nstep = 450\nset = { 'motion.gravity_m_per_s2' = 5 }";

fn question() -> InputForm {
    let fields = [("time step", "0.05 s"), ("steps", "4600")]
        .map(|(label, text)| InputField::new(label, text))
        .into();
    let keys = "Enter takes it, Esc leaves it";
    let mut form = InputForm::new("motion.time_step_s", fields, keys);
    let info = ["now 0.1 s", "a hundredth up or down: Left, Right"];
    form.info = info.map(str::to_owned).into();
    form
}

fn asked(form: &InputForm, size: (u16, u16)) -> String {
    let theme = &COLOURS;
    drawn(FormPane { form, theme }, size)
}

#[test]
fn a_form_is_shown_at_the_bottom() {
    let mut form = question();
    insta::assert_snapshot!("form", asked(&form, (60, 12)));
    let words = "motion.time_step_s (-0.1): must be greater than zero, or nothing would ever move";
    form.complaint = Some(words.to_owned());
    insta::assert_snapshot!("form_refuses", asked(&form, (40, 12)));
    insta::assert_snapshot!("form_20x4", asked(&form, (20, 4)));
    form.edit_field(FieldEdit::Next);
    insta::assert_snapshot!("form_20x3", asked(&form, (20, 3)));
    insta::assert_snapshot!("form_20x2", asked(&form, (20, 2)));
}

#[test]
fn a_long_text_scrolls_in_its_field() {
    let mut form = InputForm::new("title", vec![InputField::new("title", "")], "");
    "0123456789速い独楽abcdef"
        .chars()
        .for_each(|c| form.edit_field(FieldEdit::Type(c)));
    let field = |shown: &InputForm| {
        let picture = asked(shown, (20, 4));
        let line = picture.lines().find(|line| line.starts_with("title"));
        line.unwrap().to_owned()
    };
    // A wide character has two cells; the second is blank here.
    assert_eq!(field(&form), "title い 独 楽 abcdef_");
    form.edit_field(FieldEdit::Home);
    assert_eq!(field(&form), "title 0123456789速 い");
    (0..12).for_each(|_| form.edit_field(FieldEdit::Right));
    assert_eq!(field(&form), "title 23456789速 い 独");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn panes_never_draw_outside_their_area(
        width in 0u16..80, height in 0u16..30, marker in 0..Marker::ALL.len(), steps in 0u64..900, ghosts in 0u64..2000,
        window_s in 0.2..300.0f64, force in prop::array::uniform3(-100.0..100.0f64), begin_s in 0.0..90.0f64,
    ) {
        let set = format!("push.0.force_N={force:?}");
        let mut now = run("wobble-push", &[&set], EDITS, steps);
        let ghost = Ghost::capture(&run("wobble-push", &[], "", ghosts));
        let mut view = view(&now, Marker::ALL[marker]);
        (view.window.begin_s, view.window.end_s) = (begin_s, begin_s + window_s);
        let around = Rect::new(0, 0, width + 6, height + 6);
        let inside = Rect::new(3, 3, width, height);
        let read = Reading::new(&mut now, &Pace::new(1.0, false));
        let (ghost, reading) = (Some(&ghost), Some(&read));
        let alone = seen_alone(&now, &view);
        for pane in 0..3 {
            let mut buf = Buffer::filled(around, Cell::new("#"));
            match pane {
                0 => Traces(PlotInputs { ghost, ..alone }).render(inside, &mut buf),
                1 => FromAbove(PlotInputs { ghost, reading, ..alone }).render(inside, &mut buf),
                _ => ThreeD(PlotInputs { reading, ..alone }).render(inside, &mut buf),
            }
            for position in around.positions().filter(|position| !inside.contains(*position)) {
                prop_assert_eq!(buf[position].symbol(), "#", "{:?} of pane {}", position, pane);
            }
        }
    }

    #[test]
    fn forms_never_draw_outside_their_area(
        width in 0u16..100, height in 0u16..30, typed in "\\PC{0,40}", left in 0..20,
        complaint in prop::option::of("[a-z ]{0,90}"), fields in 0usize..5, infos in 0usize..5,
    ) {
        let around = Rect::new(0, 0, width + 6, height + 6);
        let inside = Rect::new(3, 3, width, height);
        let mut form = InputForm::new(&typed, vec![InputField::new(&typed, ""); fields], "Esc");
        typed.chars().for_each(|c| form.edit_field(FieldEdit::Type(c)));
        (0..left).for_each(|_| form.edit_field(FieldEdit::Left));
        (form.complaint, form.info) = (complaint, vec![typed.clone(); infos]);
        let theme = &Theme::PLAIN;
        let mut buf = Buffer::filled(around, Cell::new("#"));
        FormPane { form: &form, theme }.render(inside, &mut buf);
        for position in around.positions().filter(|position| !inside.contains(*position)) {
            prop_assert_eq!(buf[position].symbol(), "#", "{:?}", position);
        }
    }
}
