//! The functions of the turn between the nodes of an element ([`strain`](super::strain)).

/// Square of sin φ below which f is taken by its series, whose terms left out are below 1e-16 there, those of its second derivative too.
const SMALL: f64 = 1e-2;

/// f, 1/c and h, each with its first and second derivative by σ = a·a.
pub(super) struct Functions {
    pub(super) f: [f64; 3],
    pub(super) inverse: [f64; 3],
    pub(super) h: [f64; 3],
}

impl Functions {
    pub(super) fn of(square: f64) -> Functions {
        let cosine = (1.0 - square).sqrt();
        let f = match square < SMALL {
            true => series(square),
            false => {
                let sine = square.sqrt();
                let f = sine.asin() / sine;
                let slope = (1.0 / cosine - f) / (2.0 * square);
                let second = (0.5 / cosine.powi(3) - 3.0 * slope) / (2.0 * square);
                [f, slope, second]
            }
        };
        // of c² = (1 + cos φ)/2
        let c = (0.5 * (1.0 + cosine)).sqrt();
        let slope = -1.0 / (8.0 * c * cosine);
        let second = (slope * cosine - 0.5 * c / cosine) / (8.0 * (c * cosine).powi(2));
        let by_c = |value: f64, by_c: f64, twice: f64| {
            [value, by_c * slope, twice * slope * slope + by_c * second]
        };
        let (both, both_c, both_cc) = (
            c.powi(3) * (1.0 + c),
            3.0 * c * c + 4.0 * c.powi(3),
            6.0 * c + 12.0 * c * c,
        );
        Functions {
            f,
            inverse: by_c(1.0 / c, -1.0 / (c * c), 2.0 / c.powi(3)),
            h: by_c(
                -0.25 / both,
                0.25 * both_c / both.powi(2),
                0.25 * both_cc / both.powi(2) - 0.5 * both_c.powi(2) / both.powi(3),
            ),
        }
    }
}

/// asin(r)/r and its derivatives by r²: Σ (2k)!/(4^k k!² (2k + 1)) r^2k.
fn series(square: f64) -> [f64; 3] {
    let mut sum = [1.0, 0.0, 0.0];
    let (mut factor, mut powers) = (1.0, [1.0, 0.0]);
    for k in 1..10 {
        let n = f64::from(k);
        factor *= (2.0 * n - 1.0) / (2.0 * n);
        let own = factor / (2.0 * n + 1.0);
        // r^(2k - 2) and r^(2k - 4)
        sum[2] += own * n * (n - 1.0) * powers[1];
        sum[1] += own * n * powers[0];
        powers = [powers[0] * square, powers[0]];
        sum[0] += own * powers[0];
    }
    sum
}
