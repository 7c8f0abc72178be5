//! Numbers on the command line.

use std::ffi::OsString;
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Returns a parser of whole numbers whose error message states the range.
pub fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let number = text.parse::<T>().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("expected a whole number from {} to {}", range.start(), range.end()))
    }
}

/// Joins each argument that looks like a negative number to the option before it: `--seed -1`
/// becomes `--seed=-1`, so that the option's own parser reports any error. Without this, clap would
/// take the number for an unknown option.
pub fn joined(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut all: Vec<OsString> = Vec::new();
    for argument in arguments {
        let is_negative = argument.to_str().is_some_and(looks_negative);
        let is_option = |word: &&mut OsString| {
            word.to_str().is_some_and(|word| word.len() > 2 && word.starts_with("--") && !word.contains('='))
        };
        match all.last_mut().filter(is_option).filter(|_| is_negative) {
            Some(option) => {
                option.push("=");
                option.push(argument);
            }
            None => all.push(argument),
        }
    }
    all
}

fn looks_negative(word: &str) -> bool {
    let number = word.strip_prefix('-').unwrap_or_default();
    number.starts_with(|first: char| first.is_ascii_digit() || first == '.')
        || ["inf", "nan"].iter().any(|name| number.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_numbers_belong_to_the_option_before_them() {
        let rejoined = |line: &str| joined(line.split(' ').map(OsString::from)).join(std::ffi::OsStr::new(" "));
        for (line, expected) in [
            ("cook render ruby --seed -1", "cook render ruby --seed=-1"),
            ("cook render ruby --size -1x5 --json", "cook render ruby --size=-1x5 --json"),
            ("cook render ruby --from -20,-3", "cook render ruby --from=-20,-3"),
            ("cook render ruby --exposure -inf", "cook render ruby --exposure=-inf"),
            ("cook render ruby --exposure -.5", "cook render ruby --exposure=-.5"),
            ("cook render -1", "cook render -1"),
            ("cook render --seed=3 -1", "cook render --seed=3 -1"),
            ("cook render -- -1", "cook render -- -1"),
            ("cook render --out --json -h", "cook render --out --json -h"),
        ] {
            assert_eq!(rejoined(line), expected);
        }
    }

    #[test]
    fn a_number_out_of_range_is_told_its_range() {
        let parse = whole(1..=4u32);
        assert_eq!(parse("4"), Ok(4));
        for bad in ["0", "5", "-1", "x", "", "1.5", "99999999999999999999"] {
            assert_eq!(parse(bad), Err("expected a whole number from 1 to 4".to_owned()), "{bad}");
        }
    }
}
