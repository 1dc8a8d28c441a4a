//! Files of programs that students measure with, read as those programs write them.

use super::quantity::TIME;
use crate::scenario::csv::Csv;

/// The columns of phyphox's "Raw Data.csv" of the gyroscope, whose axes are the phone's.
const PHYPHOX: [(&str, &str); 4] = [
    ("Time (s)", TIME),
    ("Gyroscope x (rad/s)", "w1_rad_per_s"),
    ("Gyroscope y (rad/s)", "w2_rad_per_s"),
    ("Gyroscope z (rad/s)", "w3_rad_per_s"),
];
/// The columns of a text that Tracker exports: it states no units, and its own are s and m.
const TRACKER: [(&str, &str); 3] = [("t", TIME), ("x", "x_m"), ("y", "y_m")];

/// Gives the columns of such a file the names that gyrolab has for them. A value that phyphox has not is an empty place.
pub(super) fn name_columns(cells: &mut Csv) {
    let is_phyphox = PHYPHOX[..2]
        .iter()
        .all(|(own, _)| cells.names.iter().any(|name| name == own));
    let known = if is_phyphox {
        &PHYPHOX[..]
    } else if cells.is_titled {
        &TRACKER
    } else {
        return;
    };
    for name in &mut cells.names {
        if let Some((_, ours)) = known.iter().find(|(own, _)| own == name) {
            *name = (*ours).to_owned();
        }
    }
    let values = cells.rows.iter_mut().flat_map(|(_, row)| row);
    for value in values.filter(|value| is_phyphox && *value == "NaN") {
        value.clear();
    }
}
