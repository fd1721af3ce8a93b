//! Observed orders of convergence.

/// The slope of a straight line through points in logarithmic axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Exponent p of e = C x^p.
    pub order: f64,
    /// Standard error of p: sqrt(Σ r² / (n − 2) / Σ (ln x − mean)²), r the residuals of ln e; `None` for two points, which
    /// every line fits.
    pub error_bar: Option<f64>,
    /// Factor C.
    pub factor: f64,
}

/// Least squares of ln e = ln C + p ln x over the points with positive x and e; `None` if fewer than two differ in x.
pub fn fit(x: &[f64], e: &[f64]) -> Option<Fit> {
    let points = x.iter().zip(e).filter(|(x, e)| **x > 0.0 && **e > 0.0);
    let points: Vec<(f64, f64)> = points.map(|(x, e)| (x.ln(), e.ln())).collect();
    let n = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (middle, level) = (mean(&|p| p.0), mean(&|p| p.1));
    let spread: f64 = points.iter().map(|p| (p.0 - middle).powi(2)).sum();
    // no point has no mean
    if spread.is_nan() || spread <= 1e-12 {
        return None;
    }
    let product = |p: &(f64, f64)| (p.0 - middle) * (p.1 - level);
    let order = points.iter().map(product).sum::<f64>() / spread;
    let residual = |p: &(f64, f64)| (p.1 - level - order * (p.0 - middle)).powi(2);
    let squares: f64 = points.iter().map(residual).sum();
    Some(Fit {
        order,
        error_bar: (points.len() > 2).then(|| (squares / (n - 2.0) / spread).sqrt()),
        factor: (level - order * middle).exp(),
    })
}

/// Orders between neighbours, ln(e₁/e₀) / ln(x₁/x₀), one less than points; `None` where one of the two has no error.
pub fn consecutive(x: &[f64], e: &[f64]) -> Vec<Option<f64>> {
    let pairs = x.windows(2).zip(e.windows(2));
    let order = |(x, e): (&[f64], &[f64])| {
        let order = (e[1] / e[0]).ln() / (x[1] / x[0]).ln();
        (e[0] > 0.0 && e[1] > 0.0 && order.is_finite()).then_some(order)
    };
    pairs.map(order).collect()
}

/// Differences |q₁ − q₀| of neighbours, each at its first x, with those x: for q = q* + C x^p and x in a constant ratio
/// they fall with the same exponent p, whatever the unknown q* (Richardson). `None` if the ratio is not constant to 1 %,
/// or for fewer than three points.
pub fn differences(x: &[f64], q: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let ratios: Vec<f64> = x.windows(2).map(|pair| pair[1] / pair[0]).collect();
    let [first, _, ..] = ratios[..] else {
        return None;
    };
    let constant = ratios.iter().all(|r| (r / first - 1.0).abs() < 0.01);
    let differences = q.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    constant.then(|| (x[..x.len() - 1].to_vec(), differences.collect()))
}

/// Limit of the values at the finest three runs, `q* = q₀ + (q₀ − q₁) / (ρ − 1)`, ρ = (q₁ − q₂) / (q₀ − q₁), which is
/// r^p for `q = q* + C x^p` and x in the constant ratio r (Richardson). The fine end is the one where values differ less. `None` if
/// there are fewer than three runs, if the ratio of the three is not constant to 1 %, or if differences do not shrink with one sign.
pub fn extrapolate(x: &[f64], q: &[f64]) -> Option<f64> {
    let n = x.len();
    if n < 3 {
        return None;
    }
    let low = (q[1] - q[0]).abs() < (q[n - 1] - q[n - 2]).abs();
    let finest = if low {
        [0, 1, 2]
    } else {
        [n - 1, n - 2, n - 3]
    };
    let [ratio, next] = [[0, 1], [1, 2]].map(|[a, b]| x[finest[b]] / x[finest[a]]);
    let [fine, middle, coarse] = finest.map(|k| q[k]);
    let shrink = (middle - coarse) / (fine - middle);
    let constant = (next / ratio - 1.0).abs() < 0.01;
    let limit = fine + (fine - middle) / (shrink - 1.0);
    (constant && shrink > 1.0 && limit.is_finite()).then_some(limit)
}

/// Where errors have saturated: the abscissa of the coarsest point from which all orders between neighbours, towards the fine end, are below
/// half of the median of those before. `order`: of the fit; its sign tells the fine end. `consecutive`: as [`consecutive`] gives them.
pub fn saturation(x: &[f64], order: f64, consecutive: &[Option<f64>]) -> Option<f64> {
    let pairs: Option<Vec<f64>> = consecutive.iter().copied().collect();
    let mut pairs: Vec<f64> = pairs?.iter().map(|p| p * order.signum()).collect();
    let mut coarse: Vec<f64> = x.to_vec();
    if order > 0.0 {
        pairs.reverse();
        coarse.reverse();
    }
    let median = |of: &[f64]| {
        let mut sorted = of.to_vec();
        sorted.sort_by(f64::total_cmp);
        0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2])
    };
    let saturated = |k: &usize| {
        let before = median(&pairs[..*k]);
        before > 0.0 && pairs[*k..].iter().all(|p| *p < 0.5 * before)
    };
    (1..pairs.len()).find(saturated).map(|k| coarse[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: [f64; 5] = [1e-6, 2e-6, 4e-6, 8e-6, 16e-6];

    fn power(order: f64) -> Vec<f64> {
        STEPS.iter().map(|h| 3.0e5 * h.powf(order)).collect()
    }

    #[test]
    fn a_power_law_gives_its_exponent_without_error_bar() {
        for order in [0.36, 0.69, 1.0, 2.0, -1.0] {
            let errors = power(order);
            let fit = fit(&STEPS, &errors).unwrap();
            assert!((fit.order - order).abs() < 1e-12);
            assert!((fit.factor / 3.0e5 - 1.0).abs() < 1e-10);
            assert!(fit.error_bar.unwrap() < 1e-12);
            for between in consecutive(&STEPS, &errors) {
                assert!((between.unwrap() - order).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_error_bar_is_that_of_the_text_book() {
        // ln e = 0, 1, 1 at ln x = 0, 1, 2: slope 1/2, residuals -1/6, 1/3, -1/6, Σ r² = 1/6, so sqrt(1/6 / 1 / 2)
        let e = 1.0_f64.exp();
        let fit = fit(&[1.0, e, e * e], &[1.0, e, e]).unwrap();
        assert!((fit.order - 0.5).abs() < 1e-14);
        assert!((fit.error_bar.unwrap() - (1.0_f64 / 12.0).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn differences_find_the_order_without_the_limit() {
        let values: Vec<f64> = power(0.69).iter().map(|e| 42.0 - e).collect();
        let (x, d) = differences(&STEPS, &values).unwrap();
        assert!((fit(&x, &d).unwrap().order - 0.69).abs() < 1e-9);
        assert_eq!(differences(&[1.0, 2.0, 3.0], &values[..3]), None);
        assert_eq!(differences(&STEPS[..2], &values[..2]), None);
    }

    #[test]
    fn no_order_comes_from_one_point_or_from_errors_that_vanish() {
        assert_eq!(fit(&[1.0], &[1.0]), None);
        assert_eq!(fit(&[], &[]), None);
        assert_eq!(fit(&[1.0, 1.0], &[1.0, 2.0]), None);
        assert_eq!(fit(&STEPS, &[0.0; 5]), None);
        assert_eq!(consecutive(&[1.0, 2.0], &[0.0, 1.0]), [None]);
        assert_eq!(fit(&[1.0, 2.0], &[1.0, 4.0]).unwrap().error_bar, None);
    }

    #[test]
    fn values_of_a_power_law_extrapolate_to_its_limit_at_either_end() {
        for order in [0.69, 1.0, 2.0, -1.0] {
            let values: Vec<f64> = STEPS
                .iter()
                .map(|h| 42.0 - 3.0 * (h / STEPS[2]).powf(order))
                .collect();
            let limit = extrapolate(&STEPS, &values).unwrap();
            assert!((limit - 42.0).abs() < 1e-12 * 42.0, "{order}: {limit}");
        }
        // no constant ratio, too few, differences that alternate or grow towards the fine end as towards the other
        assert_eq!(extrapolate(&[1.0, 2.0, 3.0], &[1.0, 2.0, 4.0]), None);
        assert_eq!(extrapolate(&[1.0, 2.0], &[1.0, 2.0]), None);
        assert_eq!(extrapolate(&[1.0, 2.0, 4.0], &[1.0, 0.0, 2.0]), None);
        assert_eq!(extrapolate(&[1.0, 2.0, 4.0], &[1.0, 2.0, 3.0]), None);
    }

    #[test]
    fn errors_saturate_where_they_stop_to_fall() {
        let with_floor = |order: f64, floor: f64| -> Option<f64> {
            let errors: Vec<f64> = STEPS
                .iter()
                .map(|h| (h / STEPS[4]).powf(order).max(floor))
                .collect();
            let fit = fit(&STEPS, &errors).unwrap();
            saturation(&STEPS, fit.order, &consecutive(&STEPS, &errors))
        };
        assert_eq!(with_floor(1.0, 0.0), None);
        // 1, 1/2, 1/4, 1/4, 1/4: constant from the third on
        assert_eq!(with_floor(1.0, 0.25), Some(STEPS[2]));
        let rising: Vec<f64> = STEPS.iter().map(|n| (STEPS[0] / n).max(0.25)).collect();
        let fit = fit(&STEPS, &rising).unwrap();
        assert!(fit.order < 0.0);
        assert_eq!(
            saturation(&STEPS, fit.order, &consecutive(&STEPS, &rising)),
            Some(STEPS[2])
        );
    }
}
