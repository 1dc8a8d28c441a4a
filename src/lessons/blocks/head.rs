//! The `lesson` block: the subject of the lesson, its duration, and information for a teacher.

use super::{BlockContent, BlockReader, BlockResult};
use crate::engine::scenario::Problem;
use crate::engine::scenario::kind::ValueKind::{By, Line, Lines, Whole};
use crate::engine::scenario::schema::{Schema, may};
use crate::lessons::lesson::{LessonGuide, LessonLevel};
use toml::Value;

const LONGEST_LESSON: i64 = 600;

#[rustfmt::skip]
const HEAD: Schema = Schema(&[&[
    may("about", Line, "the subject of the lesson"),
    may("minutes", Whole(1, LONGEST_LESSON), "duration"),
    may("level", By(is_level), "required prior knowledge"),
    may("needs", Lines, "lessons to take first, and tools"),
    may("goals", Lines, "abilities of a student afterwards"),
    may("leaves_out", Lines, "properties of a real top that the model lacks"),
    may("page_minutes", By(are_page_minutes), "duration of each page"),
]]);

/// The content of the block.
pub(in crate::lessons) struct LessonHead {
    pub about: String,
    pub minutes: Option<u32>,
    pub guide: LessonGuide,
}

fn is_level(value: &Value) -> Result<(), String> {
    let level = value.as_str().and_then(LessonLevel::named);
    let names = LessonLevel::ALL.map(LessonLevel::name).join(", ");
    level.map(|_| ()).ok_or(format!("must be one of {names}"))
}

fn are_page_minutes(value: &Value) -> Result<(), String> {
    let rule = "must be a list with a whole number of minutes for each page";
    let numbers = value.as_array().ok_or(rule)?;
    let is_sound = numbers.iter().all(|number| minutes(number).is_some());
    is_sound.then_some(()).ok_or(rule.to_owned())
}

fn minutes(value: &Value) -> Option<u32> {
    let whole = value.as_integer()?;
    let is_sound = (0..=LONGEST_LESSON).contains(&whole);
    is_sound.then(|| u32::try_from(whole).ok()).flatten()
}

/// Parses the block. The minutes of the pages must add up to those of the lesson.
pub(in crate::lessons) fn head(reader: &BlockReader<'_>) -> BlockResult<LessonHead> {
    let mut content = BlockContent::read(reader, HEAD)?;
    let all_minutes = content.keys.get("minutes").and_then(minutes);
    let pages = content.keys.get("page_minutes").and_then(Value::as_array);
    let page_minutes: Vec<u32> = pages.into_iter().flatten().filter_map(minutes).collect();
    let sum: u32 = page_minutes.iter().sum();
    if !page_minutes.is_empty() && all_minutes != Some(sum) {
        let rule = format!("add up to {sum}, which must be the minutes of the lesson");
        content.refuse(Problem::at("page_minutes", rule));
    }
    content.finish(LessonHead {
        about: content.text("about"),
        minutes: all_minutes,
        guide: LessonGuide {
            level: LessonLevel::named(&content.text("level")),
            needs: content.texts("needs"),
            goals: content.texts("goals"),
            leaves_out: content.texts("leaves_out"),
            page_minutes,
        },
    })
}
