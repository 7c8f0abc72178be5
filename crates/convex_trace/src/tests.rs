use super::*;
use glam::{DVec3, DVec4};
use std::f64::consts::PI;

/// A linear congruential generator (Knuth's MMIX constants): enough to spread inputs, and the same on every run.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn direction(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let azimuth = 2.0 * PI * self.unit();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
    }
}

fn brilliant() -> Vec<DVec4> {
    let a = PI / 8.0;
    let (table, star, lower, girdle) = (0.53, 0.5, 0.77, 0.02);
    let crown = 34.5f64.to_radians().tan();
    let pavilion = 40.75f64.to_radians().tan();
    let at = |radius: f64, azimuth: f64, z: f64| DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z);
    let through = |p: DVec3, q: DVec3, r: DVec3| {
        let normal = (q - p).cross(r - p).normalize();
        let normal = if normal.dot(p) < 0.0 { -normal } else { normal };
        normal.extend(normal.dot(p))
    };
    let facing = |point: DVec3, normal: DVec3| { let n = normal.normalize(); n.extend(n.dot(point)) };
    let top = girdle + (1.0 - table) * crown;
    let star_radius = table * a.cos() + star * (1.0 - table * a.cos());
    let star_top = girdle + (1.0 - star_radius * a.cos()) * crown;
    let lower_radius = 1.0 - lower;
    let lower_z = -girdle - (1.0 - lower_radius * a.cos()) * pavilion;
    let mut planes = vec![DVec3::Z.extend(top)];
    for k in 0..8 {
        let azimuth = 2.0 * a * k as f64;
        planes.push(through(at(table, azimuth, top), at(table, azimuth + 2.0 * a, top), at(star_radius, azimuth + a, star_top)));
        planes.push(facing(at(1.0, azimuth, girdle), at(crown, azimuth, 1.0)));
        planes.push(facing(at(1.0, azimuth, -girdle), at(pavilion, azimuth, -1.0)));
        for side in [-1.0, 1.0] {
            planes.push(through(at(star_radius, azimuth + side * a, star_top), at(1.0, azimuth, girdle), at(1.0, azimuth + side * a, girdle)));
            planes.push(through(at(lower_radius, azimuth + side * a, lower_z), at(1.0, azimuth, -girdle), at(1.0, azimuth + side * a, -girdle)));
            planes.push(at((0.5 * a).cos(), azimuth + 0.5 * side * a, 0.0).normalize().extend((0.5 * a).cos()));
        }
    }
    planes
}

#[test]
fn explore() {
    let exact = brilliant();
    assert_eq!(exact.len(), 73);
    for (size, offset) in [(1.0, 0.0), (1e-4, 0.0), (1e4, 0.0), (1.0, 1e4)] {
        for project in [true, false] {
            for use_left in [true, false] {
            let shift = DVec3::new(0.6, 0.48, 0.64) * offset;
            let planes: Vec<Vec4> = exact.iter().map(|p| (p.xyz()).extend(p.w * size + p.xyz().dot(shift)).as_vec4()).collect();
            let wide: Vec<DVec4> = planes.iter().map(|p| p.as_dvec4()).collect();
            let mut random = Random(1);
            let (mut same, mut n, mut worst_dir, mut least_margin, mut worst_margin, mut lost) = (0, 0, 0.0f64, f64::MAX, 0.0f64, 0);
            let (mut residual, mut rn) = (0.0f64, 0.0);
            let mut errs = vec![]; let mut perr = vec![];
            for _ in 0..20000 {
                let start = (random.direction() * size * 0.3 + shift).as_vec3();
                let r = random.direction().as_vec3();
                let (mut p32, mut r32, mut left32) = (start, r, CONVEX_TRACE_NONE);
                let (mut p64, mut r64, mut left64) = (start.as_dvec3(), r.as_dvec3(), CONVEX_TRACE_NONE);
                let mut margin = f64::MAX;
                n += 1;
                let mut ok = true;
                for _ in 0..64 {
                    let hit = trace(&planes, p32, r32, if use_left {left32} else {CONVEX_TRACE_NONE});
                    let (t, face) = oracle::trace(&wide, p64, r64, left64);
                    if hit.face == CONVEX_TRACE_NONE { lost += 1; ok = false; break; }
                    p64 += t * r64;
                    let w = wide[face as usize];
                    p64 -= (w.xyz().dot(p64) - w.w) * w.xyz();
                    for (i, q) in wide.iter().enumerate() { if i as u32 != face { margin = margin.min((q.w - q.xyz().dot(p64)) / size); } }
                    if hit.face != face { ok = false; break; }
                    r64 -= 2.0 * w.xyz().dot(r64) * w.xyz();
                    let v = planes[face as usize];
                    let d = distance(hit);
                    p32 = if project { point(p32, r32, d, v) } else { point_naive(p32, r32, d) };
                    residual = residual.max(((w.xyz().dot(p32.as_dvec3()) - w.w) / size).abs());
                    rn += ((w.xyz().dot(p32.as_dvec3()) - w.w) / size).abs();
                    r32 -= 2.0 * v.xyz().dot(r32) * v.xyz();
                    left32 = face; left64 = face;
                }
                if ok { same += 1; worst_dir = worst_dir.max(r64.normalize().distance(r32.as_dvec3().normalize())); least_margin = least_margin.min(margin);
                    errs.push(r64.normalize().distance(r32.as_dvec3().normalize())); perr.push(p64.distance(p32.as_dvec3())/size);
                } else { worst_margin = worst_margin.max(margin); }
            }
            errs.sort_by(f64::total_cmp); perr.sort_by(f64::total_cmp);
            println!("size {size:e} offset {offset:e} project {project} left {use_left}: same {same}/{n} lost {lost} dir max {worst_dir:.2e} med {:.2e} pos med {:.2e} p99 {:.2e} max {:.2e} least ok margin {least_margin:.2e} worst bad margin {worst_margin:.2e} residual max {residual:.2e} mean {:.2e}",
               errs[errs.len()/2], perr[perr.len()/2], perr[perr.len()*99/100], perr[perr.len()-1], rn / (64.0*n as f64));
            }
        }
    }
}
