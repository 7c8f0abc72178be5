//! Golden-section search: the minimum of a function of one number.

/// The inverse of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Returns the place between `low` and `high` at which `value` is least, to 0.618^`narrowings` of
/// their distance if there is one minimum. Evaluates `value` twice, and once more for each
/// narrowing.
///
/// # Errors
/// Returns the first error of `value`.
pub fn golden_section<E>(
    [mut low, mut high]: [f64; 2],
    narrowings: usize,
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut values = [value(inner[0])?, value(inner[1])?];
    for _ in 0..narrowings {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [high - GOLDEN * (high - low), inner[0]];
            values = [value(inner[0])?, values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + GOLDEN * (high - low)];
            values = [values[1], value(inner[1])?];
        }
    }
    Ok(if values[0] <= values[1] { inner[0] } else { inner[1] })
}

#[cfg(test)]
mod tests {
    use super::golden_section;
    use std::convert::Infallible;

    #[test]
    fn a_minimum_is_found_inside_and_at_either_end() {
        for minimum in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            let mut asked = 0;
            let Ok(found) = golden_section([-1.0, 1.0], 30, |x| {
                asked += 1;
                Ok::<f64, Infallible>((x - minimum).abs())
            });
            assert!((found - minimum).abs() < 2e-6, "{minimum}: {found}");
            assert_eq!(asked, 32);
        }
    }

    #[test]
    fn an_error_ends_the_search() {
        assert_eq!(golden_section([0.0, 1.0], 5, |x| if x > 0.7 { Err("too far") } else { Ok(-x) }), Err("too far"));
    }
}
