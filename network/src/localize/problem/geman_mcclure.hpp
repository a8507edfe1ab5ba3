#pragma once

namespace isotherm::network::detail {

/// Geman and McClure's loss s / (1 + s / width^2) of a squared deviation s, and its
/// derivative, which is the weight of a reweighted least-squares step. An infinite
/// width is plain least squares, a width of 0 no loss at all.
struct GemanMcClure {
  double width = 0.0;

  double loss(double squared) const {
    return width > 0.0 ? squared / (1.0 + squared / (width * width)) : 0.0;
  }
  double weight(double squared) const {
    if (width == 0.0) return 0.0;
    const double share = 1.0 / (1.0 + squared / (width * width));
    return share * share;
  }
};

}  // namespace isotherm::network::detail
