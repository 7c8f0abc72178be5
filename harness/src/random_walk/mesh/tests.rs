use super::*;
use std::time::Instant;

#[test]
fn speed() {
    let scene = Scene::named("skin_bunny").expect("built in");
    for samples in [16] {
        let settings = Settings { width: 256, height: 256, samples_per_pixel: samples, seed: 1, environment: None };
        let start = Instant::now();
        let rendering = render(&scene, &settings, &|_, _| {}).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let full = || rendering.linear.iter().zip(&rendering.standard_error).filter(|(p, _)| p[3] == 1.0);
        let count = full().count() as f64;
        for k in 0..3 {
            let mean = full().map(|(p, _)| f64::from(p[k])).sum::<f64>() / count;
            let mut errors: Vec<f64> = full().map(|(_, e)| f64::from(e[k])).collect();
            let mut own: Vec<f64> = full().map(|(p, e)| f64::from(e[k] / p[k])).collect();
            errors.sort_by(f64::total_cmp);
            own.sort_by(f64::total_cmp);
            let rms = (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt();
            println!(
                "channel {k}: mean {mean:.4}, median error {:.2} %, rms {:.2} % of the mean; median relative {:.2} %; per sample {:.3}",
                100.0 * errors[errors.len() / 2] / mean,
                100.0 * rms / mean,
                100.0 * own[own.len() / 2],
                rms / mean * f64::from(samples).sqrt()
            );
        }
        println!(
            "{samples}: {seconds:.2} s, {} walks, {} scatterings, {} lost: {:.0} walks/s {:.2} M scatterings/s",
            rendering.walks,
            rendering.scatterings,
            rendering.lost,
            rendering.walks as f64 / seconds,
            rendering.scatterings as f64 / seconds / 1e6
        );
    }
}
