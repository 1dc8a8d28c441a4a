//! Figures of sweeps: measurements, theory, other readouts and curves are distinguishable.

use crate::figures::{check_overlaps, says, table, words};
use gyrolab::plot::COLUMN_PT;
use gyrolab::plot::chart::{Chart, ChartSeries, EXACT_COLOR};
use gyrolab::plot::ink::PointMark;
use gyrolab::report::figure::FigureSpec;
use gyrolab::report::figure::of_table::{self, TableKind, TableView};

#[test]
fn gaps_in_a_theory_line_are_explained() {
    let gappy = SWEEP.replace("0.000001,0.84,", "0.000001,,");
    let told = |text: &str| of_table::warning(&table(text), &chart(text));
    let said = |text: &str| told(text).unwrap_or_default();
    assert!(said(&gappy).starts_with("2 of 8 values have no point: "));
    let whole = SWEEP.replace("30,,,0.87,\n", "");
    assert_eq!(told(&whole), None);
    // A logarithmic axis cannot show 0.
    let zero = whole
        .replace("0.90,0.01", "0,0.01")
        .replace("0.88,0.02", "900,0.02");
    assert!(said(&zero).starts_with("1 of 6 values"));
    let names = |text: &str| chart(text).panels[0].series[0].name.clone();
    assert_eq!(names(&gappy), "theory (gaps: no prediction)");
    assert_eq!(names(SWEEP), "theory");
}

#[test]
fn two_theories_of_one_quantity_have_different_marks() {
    let both = SWEEP
        .replace(
            "predicted_precession_rad_per_s,path",
            "predicted_precession_rad_per_s,fast_top_precession_rad_per_s,path",
        )
        .replace("cusps\n", "0.8,cusps\n")
        .replace("0.87,\n", "0.87,0.8,\n")
        .replace("scenario = \"0.8,cusps", "scenario = \"cusps");
    let chart = chart(&both);
    let series = chart.panels[0].series.iter();
    let marks: Vec<_> = series.map(|series| series.style.mark).collect();
    assert_eq!(
        marks,
        [PointMark::Cross, PointMark::Plus, PointMark::Dot].map(Some)
    );
}

const SWEEP: &str = "\
# scenario = \"cusps\"
# measure = [\"measured_precession_rad_per_s\"]
# [[vary]]
# key = \"start.tilt_deg\"
# values = [10, 20, 30, 40]
start.tilt_deg,measured_precession_rad_per_s,measured_precession_uncertainty_rad_per_s,predicted_precession_rad_per_s,path
10,0.90,0.01,0.91,cusps
20,0.88,0.02,0.89,cusps
30,,,0.87,
40,0.84,0.000001,0.84,cusps
";

#[test]
fn a_sweep_shows_measurements_with_error_bars_and_the_predicted_line() {
    let chart = of_table::chart(&table(SWEEP), &TableView::of_columns(&[], COLUMN_PT)).unwrap();
    let [panel] = &chart.panels[..] else {
        panic!("{chart:?}")
    };
    assert_eq!(panel.series.len(), 2);
    assert_eq!(panel.series[0].style.mark, Some(PointMark::Cross));
    assert_eq!(panel.series[1].style.width_pt, 0.0);
    assert_eq!(panel.series[1].errors[1][..2], [0.01, 0.02]);
    let scene = chart.scene();
    check_overlaps(&scene).unwrap();
    says(
        &scene,
        &[
            "theory",
            "simulated",
            "errors of reading the run smaller than marks where no bar is drawn",
            "θ₀ (°)",
        ],
    );
}

fn chart(text: &str) -> Chart {
    let chart = of_table::chart(&table(text), &TableView::of_columns(&[], COLUMN_PT)).unwrap();
    check_overlaps(&chart.scene()).unwrap();
    chart
}

fn names(series: &[ChartSeries]) -> Vec<&str> {
    series.iter().map(|series| series.name.as_str()).collect()
}

/// The CSV of a sweep over two keys with one curve per value of `key`, with columns of theory and measurement.
fn two_keys(key: &str, rows: &str) -> String {
    format!(
        "# [[vary]]\n# key = \"{key}\"\n# values = [1]\n# [[vary]]\n# key = \"start.tilt_deg\"\n# values = [1]\n\
         # [scenario.start]\n# momentum_frame = \"body\"\n\
         {key},start.tilt_deg,measured_precession_rad_per_s,fast_top_precession_rad_per_s,turns_per_step\n{rows}"
    )
}

#[test]
fn theory_is_drawn_once_for_several_measured_curves() {
    let rows =
        "report,10,0.9,0.8,0.1\nreport,20,0.8,0.7,0.1\nrk4,10,0.91,0.8,0.1\nrk4,20,0.81,0.7,0.1\n";
    let chart = chart(&two_keys("motion.scheme", rows));
    let [precession, turns] = &chart.panels[..] else {
        panic!("{chart:?}")
    };
    assert_eq!(precession.y.name, "*Ω*_{p}");
    assert_eq!(
        names(&precession.series),
        [
            "*M* *g* *h*/*L*_{3}",
            "simulated, the report's scheme",
            "simulated, rk4"
        ]
    );
    assert_eq!(precession.series[0].style.mark, Some(PointMark::Cross));
    assert_eq!(precession.series[1].style.mark, Some(PointMark::Dot));
    // A readout that is neither has no mark of a measurement, and its own name.
    assert_eq!(
        names(&turns.series),
        ["simulated, without error", "simulated, without error"]
    );
    assert_eq!(turns.series[0].style.mark, Some(PointMark::Speck));
}

#[test]
fn theories_that_differ_have_one_line_per_curve_and_one_name() {
    let rows =
        "60.0,10,0.9,0.8,0.1\n60.0,20,0.8,0.7,0.1\n-80.5,10,0.91,0.6,0.1\n-80.5,20,0.81,0.5,0.1\n";
    let chart = chart(&two_keys("start.momentum_Js.2", rows));
    assert_eq!(
        names(&chart.panels[0].series),
        [
            "*M* *g* *h*/*L*_{3}",
            "*M* *g* *h*/*L*_{3}",
            "simulated, *L*_{3,0} = 60 J s",
            "simulated, *L*_{3,0} = −80.5 J s"
        ]
    );
    let shown = words(&chart.scene()).join("; ");
    assert_eq!(shown.matches("M g h").count(), 1, "{shown}");
}

#[test]
fn curves_are_named_by_symbol_value_and_unit() {
    for (key, name) in [
        ("start.azimuth_deg", "simulated, *φ*_{0} = −100°"),
        ("push.0.force_N.2", "simulated, push 0 force *z* = −100 N"),
        ("motion.time_step_s", "simulated, Δ*t* = −100 s"),
    ] {
        let rows = "-100.0,10,0.9,0.8,0.1\n-100.0,20,0.8,0.7,0.1\n";
        let chart = chart(&two_keys(key, rows));
        assert_eq!(chart.panels[0].series[1].name, name);
    }
}

#[test]
fn a_curve_of_failed_runs_is_labeled_as_such() {
    let rows = "report,10,0.9,0.8,0.1\nreport,20,0.8,0.7,0.1\nrk4,10,,,\nrk4,20,,,\n";
    let text = two_keys("motion.scheme", rows);
    let scene = chart(&text).scene();
    let failed = "rk4: no run gave a number";
    says(&scene, &["simulated, the report's scheme", failed]);
    assert!(!words(&scene).contains(&"simulated, rk4"));
}

#[test]
fn many_rows_of_theory_are_drawn_as_a_line() {
    let rows: String = (0..60)
        .map(|row| format!("report,{row},0.9,0.8,0.1\n"))
        .collect();
    let chart = chart(&two_keys("motion.scheme", &rows));
    assert_eq!(chart.panels[0].series[0].style.mark, None);
    assert!(chart.panels[0].series[0].style.dash_pt.is_empty());
}

#[test]
fn too_many_quantities_are_rejected_with_the_option_to_choose() {
    let names = ["x_m", "y_m", "z_m", "Lx_Js", "Ly_Js", "Lz_Js", "tilt_deg"];
    let text = format!(
        "# [[vary]]\n# key = \"motion.steps\"\nmotion.steps,{},measured_lowest_z_m\n1,1,1,1,1,1,1,1,1\n",
        names.join(",")
    );
    let table = table(&text);
    let refusal = of_table::chart(&table, &TableView::of_columns(&[], COLUMN_PT)).unwrap_err();
    let (_, example) = refusal.split_once("--kind ").unwrap();
    let example = example.split([';', ' ']).next().unwrap();
    let columns: Vec<_> = example.split(',').collect();
    assert_eq!(columns, ["measured_lowest_z_m", "x_m"]);
    assert!(of_table::chart(&table, &TableView::of_columns(&columns, COLUMN_PT)).is_ok());
    assert!(refusal.starts_with("8 quantities"), "{refusal}");
}

/// Returns the CSV of a sweep over 13 tilts and 14 spins, with one missing number.
fn grid() -> String {
    let mut text = "# [[vary]]\n# key = \"start.tilt_deg\"\n# values = [1]\n\
        # [[vary]]\n# key = \"start.spin_rpm\"\n# values = [1]\n\
        start.tilt_deg,start.spin_rpm,measured_precession_rad_per_s,predicted_precession_rad_per_s,reliable\n"
        .to_owned();
    for tilt in 1..=13 {
        for spin in 1..=14 {
            let value = if (tilt, spin) == (5, 7) {
                String::new()
            } else {
                format!("{}", f64::from(tilt) + 0.01 * f64::from(spin))
            };
            text += &format!("{},{},{value},{value},true\n", 10 * tilt, 100 * spin);
        }
    }
    text
}

fn map_view(x: Option<&str>) -> TableView {
    TableView {
        kind: TableKind::Map,
        x: x.map(str::to_owned),
        width_pt: COLUMN_PT,
        ..TableView::default()
    }
}

#[test]
fn a_map_has_a_cell_for_each_pair_of_values() {
    let text = grid();
    let chart = of_table::chart(&table(&text), &map_view(None)).unwrap();
    let scene = chart.scene();
    check_overlaps(&scene).unwrap();
    // The measurement is drawn, and theory only on request; `reliable` is not a quantity.
    let [panel] = &chart.panels[..] else {
        panic!("{} panels", chart.panels.len())
    };
    let map = panel.map.as_ref().unwrap();
    assert_eq!((map.values.len(), map.values[0].len()), (13, 14));
    assert_eq!(map.values[2][3], 3.04);
    assert!(map.values[4][6].is_nan());
    says(
        &scene,
        &[
            "ω_(3,0) (rpm)",
            "θ₀ (°)",
            "Ω_p (rad s⁻¹)",
            "crossed: no value",
        ],
    );
    let turned = of_table::chart(&table(&text), &map_view(Some("start.tilt_deg"))).unwrap();
    let values = &turned.panels[0].map.as_ref().unwrap().values;
    assert_eq!((values.len(), values[0].len()), (14, 13));
    assert_eq!(values[3][2], 3.04);
}

#[test]
fn a_map_needs_two_keys_with_numbers() {
    let rows =
        "report,10,0.9,0.8,0.1\nreport,20,0.8,0.7,0.1\nrk4,10,0.91,0.8,0.1\nrk4,20,0.81,0.7,0.1\n";
    let refusal = |text: &str, x| of_table::chart(&table(text), &map_view(x)).unwrap_err();
    let told = refusal(&two_keys("motion.scheme", rows), None);
    assert!(told.contains("two keys that vary over numbers"), "{told}");
    let of_readout = refusal(&grid(), Some("reliable"));
    assert!(
        of_readout.contains("start.spin_rpm or start.tilt_deg")
            || of_readout.contains("start.tilt_deg or start.spin_rpm"),
        "{of_readout}"
    );
}

#[test]
fn a_table_of_too_many_curves_suggests_a_map() {
    let refusal = of_table::chart(&table(&grid()), &TableView::of_columns(&[], COLUMN_PT));
    let told = refusal.unwrap_err();
    assert!(told.starts_with("13 curves"), "{told}");
    assert!(told.contains("--kind map"), "{told}");
}

#[test]
fn any_column_can_be_the_x_axis() {
    let rows = "report,10,0.9,0.8,3\nreport,20,0.8,0.7,2\nrk4,10,0.91,0.8,3\nrk4,20,0.81,0.7,2\n";
    let text = two_keys("motion.scheme", rows);
    let over = |x: &str| TableView {
        x: Some(x.to_owned()),
        ..TableView::of_columns(&["measured_precession_rad_per_s"], COLUMN_PT)
    };
    let chart = of_table::chart(&table(&text), &over("turns_per_step")).unwrap();
    assert_eq!(chart.x.name, "turns per step");
    assert_eq!(chart.panels[0].series[0].points, [[2.0, 0.8], [3.0, 0.9]]);
    let wrong = of_table::chart(&table(&text), &over("turns_per_stp")).unwrap_err();
    assert!(wrong.contains("turns_per_step"), "{wrong}");
    let within = |range| TableView {
        x_range: Some(range),
        ..over("turns_per_step")
    };
    let part = of_table::chart(&table(&text), &within((1.0, 2.5))).unwrap();
    let (low, high) = part.panels[0].y.range.unwrap();
    assert!(0.7 < low && high < 0.9, "{low} to {high}");
    let none = of_table::chart(&table(&text), &within((5.0, 6.0))).unwrap_err();
    assert!(none.contains("no point"), "{none}");
}

#[test]
fn legend_digits_distinguish_the_values() {
    let rows: String = ["0.00158489319246111", "0.00251188643150958", "0.0025118"]
        .iter()
        .flat_map(|value| {
            [
                format!("{value},10,0.9,0.8,0.1\n"),
                format!("{value},20,0.9,0.8,0.1\n"),
            ]
        })
        .collect();
    let chart = chart(&two_keys("motion.time_step_s", &rows));
    let names: Vec<_> = names(&chart.panels[0].series)
        .into_iter()
        .filter(|name| name.contains("Δ"))
        .map(|name| name.rsplit(' ').nth(1).unwrap().to_owned())
        .collect();
    assert_eq!(names, ["0.0015849", "0.0025119", "0.0025118"]);
}

#[test]
fn theory_is_drawn_over_paler_points() {
    let rows: String = (0..300)
        .map(|row| format!("report,{row},0.9,0.8,0.1\n"))
        .collect();
    let chart = chart(&two_keys("motion.scheme", &rows));
    let [theory, points] = &chart.panels[0].series[..] else {
        panic!("{:?}", names(&chart.panels[0].series))
    };
    assert!(points.style.is_behind && !theory.style.is_behind);
    assert_ne!(points.style.color, theory.style.color);
}

#[test]
fn options_replace_the_figure_block_of_a_sweep() {
    let block = "# [figure]\n# x = \"turns_per_step\"\n# y = [\"fast_top_precession_rad_per_s\"]\n# log = \"y\"\n";
    let rows = "report,10,0.9,0.8,3\nreport,20,0.8,0.7,2\n";
    let text = two_keys("motion.scheme", rows)
        .replace("# [scenario.start]", &format!("{block}# [scenario.start]"));
    let of = |spec: &FigureSpec| {
        let table = table(&text);
        of_table::chart(&table, &TableView::new(&table, spec)).unwrap()
    };
    let own = of(&FigureSpec::default());
    assert_eq!(own.x.name, "turns per step");
    assert_eq!((own.panels.len(), own.panels[0].y.is_log), (1, true));
    let asked = of(&FigureSpec {
        x: Some("start.tilt_deg".to_owned()),
        y: vec!["measured_precession_rad_per_s".to_owned()],
        ..FigureSpec::default()
    });
    assert_eq!(asked.x.name, "*θ*_{0}");
    assert_eq!(asked.panels[0].series[0].points[0], [10.0, 0.9]);
}

#[test]
fn the_exact_motion_of_a_sweep_has_its_own_color() {
    let rows = "exact,10,0.9,,0.1\nexact,20,0.8,,0.1\nrk4,10,0.91,,0.1\nrk4,20,0.81,,0.1\n";
    let chart = chart(&two_keys("motion.scheme", rows));
    let [exact, rk4] = &chart.panels[0].series[..] else {
        panic!("{:?}", names(&chart.panels[0].series))
    };
    assert_eq!(
        (&*exact.name, exact.style.color),
        ("exact motion", EXACT_COLOR)
    );
    assert!(!exact.style.dash_pt.is_empty());
    assert_ne!(rk4.style.color, EXACT_COLOR);
}
