//! Files of measured data as they are read.

use gyrolab::data::SHIPPED;
use gyrolab::data::{Data, Measured, Series, Table, open, read};
use toml::Value;

#[track_caller]
fn measured(text: &str) -> Measured {
    read("lab.csv", text).unwrap_or_else(|problems| panic!("{problems}"))
}

#[track_caller]
fn series(text: &str) -> Series {
    match measured(text).data {
        Data::Series(series) => series,
        Data::Table(_) => panic!("is a table of runs: {text}"),
    }
}

#[track_caller]
fn table(text: &str) -> Table {
    match measured(text).data {
        Data::Table(table) => table,
        Data::Series(_) => panic!("is a time series: {text}"),
    }
}

#[test]
fn a_time_series_has_curves_with_gaps_and_uncertainties() {
    let text = "\u{feff}# a wheel\n#  on a string\nt_s,tilt_deg,spin_rpm,tilt_uncertainty_deg\n\
                0,30,,0.5\n\n# stopped for lunch\n1.5,31.5,600,\n1.5,32,,0.25\n";
    let measured = measured(text);
    assert_eq!(measured.about, "a wheel\n on a string\n");
    assert_eq!(measured.clone().keep_rows(|_| true), 4);
    let series = series(text);
    assert_eq!(series.times_s, [0.0, 1.5, 1.5]);
    assert_eq!(measured.lines, [4, 7, 8]);
    let [tilt, spin] = &series.curves[..] else {
        panic!("{series:?}")
    };
    let points = |curve: &gyrolab::data::Curve| -> Vec<(usize, f64, Option<f64>)> {
        let points = curve.points.iter();
        points
            .map(|point| (point.row, point.value, point.sigma))
            .collect()
    };
    assert_eq!(tilt.quantity.name, "tilt_deg");
    assert_eq!(
        points(tilt),
        [(0, 30.0, Some(0.5)), (1, 31.5, None), (2, 32.0, Some(0.25))]
    );
    assert_eq!(points(spin), [(1, 600.0, None)]);
    assert_eq!(spin.quantity.readout().unwrap().unit, "rpm");
}

#[test]
fn a_table_of_runs_has_settings_and_readouts() {
    let table = table(
        "motion.scheme,start.spin_rpm,start.spin_uncertainty_rpm,tilt_deg\nrk4,300,5,1\n,400,,\n",
    );
    let [scheme, spin] = &table.settings[..] else {
        panic!("{table:?}")
    };
    assert_eq!(scheme.values[0].as_ref().unwrap().as_str(), Some("rk4"));
    assert_eq!(scheme.values[1], None);
    let spins: Vec<_> = spin.values.iter().flatten().map(Value::as_float).collect();
    assert_eq!(spins, [Some(300.0), Some(400.0)]);
    assert_eq!(spin.sigmas, [Some(5.0), None]);
    assert_eq!(table.readouts[0].readout.name, "tilt_deg");
    assert_eq!(table.readouts[0].points.len(), 1);
}

#[test]
fn a_spreadsheet_with_decimal_commas_is_read_as_it_is_meant() {
    let with_commas = series("\u{feff}t_s;tilt_deg;;\r\n0;1,5;;\r\n2,25;-3,5e1;;\r\n;;;\r\n");
    assert_eq!(with_commas.times_s, [0.0, 2.25]);
    assert_eq!(with_commas.curves[0].points[1].value, -35.0);
    let with_tabs = series("t_s\ttilt_deg\n0\t1.5\n");
    assert_eq!(with_tabs.curves[0].points[0].value, 1.5);
}

#[test]
fn what_gyrolab_exports_is_measured_data_too() {
    use gyrolab::export::CsvWriter;
    use gyrolab::export::layout::LayoutFile;
    let scenario = std::sync::Arc::new(crate::support::scenarios::preset("steady-slow", &[]));
    for excel in [false, true] {
        let layout = LayoutFile {
            excel,
            ..LayoutFile::default()
        };
        let layout = layout.check().unwrap();
        let mut csv = CsvWriter::with_layout(Vec::new(), &scenario, layout).unwrap();
        let simulation = gyrolab::run::Simulation::new(std::sync::Arc::clone(&scenario));
        csv.write(&simulation.sample()).unwrap();
        let text = String::from_utf8(csv.finish().unwrap()).unwrap();
        let series = series(&text);
        assert_eq!(series.curves.len(), 12, "{text}");
        let tilt = series
            .curves
            .iter()
            .find(|curve| curve.quantity.name == "tilt_deg");
        assert_eq!(tilt.unwrap().points[0].value, simulation.sample().tilt_deg);
    }
}

#[test]
fn the_data_that_come_with_the_program_are_read() {
    for data in SHIPPED {
        let measured = open(data.name).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(measured.about.contains("Heidelberg"), "{}", data.name);
        assert!(measured.clone().keep_rows(|_| true) > 6);
    }
}
