//! The page of a figure: its size, and the size of its letters.
//!
//! A chart is laid out for letters of one size. For other letters, the chart is laid out on a smaller or larger page and
//! then magnified: lines and marks grow with the letters.

use super::spec::{FigureSpec, WIDTHS_MM};
use crate::engine::text::number::shortest;
use crate::plot::chart::Chart;
use crate::plot::chart::layout::least_height_pt;
use crate::plot::ink::{TITLE_PT, at};
use crate::plot::scene::PageScene;
use crate::plot::{COLUMN_PT, PT_PER_MM};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// The sizes of letters that a figure may have, pt.
pub const FONT_SIZES_PT: RangeInclusive<f64> = 4.0..=72.0;

/// A slide is 16:9.
const SLIDE_WIDTH_PT: f64 = 254.0 * PT_PER_MM;
const SLIDE_HEIGHT_PT: f64 = 142.9 * PT_PER_MM;
const SLIDE_FONT_PT: f64 = 18.0;

/// A page may be narrower than the narrowest by rounding.
const ROOM_ROUNDING: f64 = 1.0 - 1e-9;

/// What a figure is made for: sets the size of its page and letters if they are not given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PageStyle {
    /// A column of a journal.
    #[default]
    Paper,
    /// A slide on a screen.
    Slide,
}

/// The names of the page styles, as options have them.
pub const PAGE_STYLE_NAMES: [&str; 2] = ["paper", "slide"];

impl PageStyle {
    /// Returns the style with this name.
    pub fn named(name: &str) -> Option<Self> {
        let place = PAGE_STYLE_NAMES.iter().position(|other| *other == name)?;
        Some([Self::Paper, Self::Slide][place])
    }
}

impl FigureSpec {
    /// Returns the width on which the figure is laid out, pt, before it is magnified.
    pub fn page_width_pt(&self) -> f64 {
        self.given_width_pt() / self.magnification()
    }

    /// Returns the height to which the figure is laid out, pt, before it is magnified; `None` if it is as high as it
    /// needs to be.
    pub(super) fn page_height_pt(&self) -> Option<f64> {
        Some(self.given_height_pt()? / self.magnification())
    }

    /// Returns the width of the page, pt.
    pub(super) fn given_width_pt(&self) -> f64 {
        self.width_pt.unwrap_or(match self.style {
            PageStyle::Paper => COLUMN_PT,
            PageStyle::Slide => SLIDE_WIDTH_PT,
        })
    }

    fn given_height_pt(&self) -> Option<f64> {
        self.height_pt.or(match self.style {
            PageStyle::Paper => None,
            PageStyle::Slide => Some(SLIDE_HEIGHT_PT),
        })
    }

    /// Returns the size of the letters of the axis titles relative to their usual size.
    fn magnification(&self) -> f64 {
        let font_pt = self.font_pt.unwrap_or(match self.style {
            PageStyle::Paper => TITLE_PT,
            PageStyle::Slide => SLIDE_FONT_PT,
        });
        font_pt / TITLE_PT
    }

    /// Makes `chart` as high as this figure asks for.
    ///
    /// # Errors
    /// Returns an error if its panels have no room.
    pub(super) fn set_height(&self, chart: &mut Chart) -> Result<(), String> {
        let Some(height_pt) = self.page_height_pt() else {
            return Ok(());
        };
        let room_pt = height_pt - self.labels.title_height_pt();
        let least_pt = least_height_pt(chart);
        if room_pt < least_pt {
            let least_mm = (least_pt + height_pt - room_pt) * self.magnification() / PT_PER_MM;
            return Err(format!(
                "--height leaves no room for the panels: it must be {} mm or more",
                least_mm.ceil()
            ));
        }
        chart.height_pt = Some(room_pt);
        Ok(())
    }

    /// Draws a picture that has its own shape so narrow that it is no higher than the page.
    pub(super) fn fitted(&self, mut draw: impl FnMut(&Self) -> PageScene) -> PageScene {
        let mut scene = draw(self);
        let mut spec = self.clone();
        while let Some(width_pt) = spec.narrower_pt(&scene) {
            spec.width_pt = Some(width_pt);
            scene = draw(&spec);
        }
        scene
    }

    /// Returns a smaller width for a figure if its picture, `scene`, is too high for the page, pt.
    fn narrower_pt(&self, scene: &PageScene) -> Option<f64> {
        /// Labels do not shrink with the picture: it becomes narrower by this factor more.
        const SHRINK: f64 = 0.99;
        const LEAST_WIDTH_PT: f64 = 40.0;
        let room_pt = self.page_height_pt()? - self.labels.title_height_pt();
        let share = room_pt / scene.height_pt;
        let width_pt = self.given_width_pt() * share * SHRINK;
        let has_room = width_pt > LEAST_WIDTH_PT * self.magnification();
        (share < 1.0 && has_room).then_some(width_pt)
    }

    /// Puts `scene` on the page of this figure: with its title, in the middle if the page is larger, and magnified.
    pub(super) fn on_page(&self, mut scene: PageScene) -> PageScene {
        self.labels.write_title(&mut scene);
        let width_pt = scene.width_pt.max(self.page_width_pt());
        let height_pt = scene.height_pt.max(self.page_height_pt().unwrap_or(0.0));
        let (right, down) = (
            0.5 * (width_pt - scene.width_pt),
            0.5 * (height_pt - scene.height_pt),
        );
        (scene.width_pt, scene.height_pt) = (width_pt, height_pt);
        if (right, down) != (0.0, 0.0) {
            scene.map(|point| at(point.x + right, point.y + down));
        }
        scene.magnify(self.magnification());
        scene
    }

    /// Checks that the page has room for its letters.
    ///
    /// # Errors
    /// Returns an error if it has not.
    pub(super) fn check_letters(&self) -> Result<(), String> {
        if self.page_width_pt() >= WIDTHS_MM.start() * PT_PER_MM * ROOM_ROUNDING {
            return Ok(());
        }
        Err(format!(
            "letters of {} pt are too large for a page of {} mm: choose a larger --width, or a smaller --font-size",
            shortest(TITLE_PT * self.magnification()),
            shortest((self.given_width_pt() / PT_PER_MM).round())
        ))
    }

    /// Returns whether the page and its letters have sizes that the command line allows.
    pub(super) fn has_page(&self) -> bool {
        let is_size = |pt: f64| WIDTHS_MM.contains(&((pt / PT_PER_MM * 1e6).round() / 1e6));
        let mut sizes = [self.width_pt, self.height_pt].into_iter().flatten();
        sizes.all(is_size) && self.font_pt.is_none_or(|pt| FONT_SIZES_PT.contains(&pt))
    }
}
