#pragma once

#include <array>

namespace isotherm::slam::detail {

/// How many loops are true: by themselves, first ones of runs or copies of the one before; and next
/// ones of runs, along which that is a Markov chain. Of none of those four probabilities anything
/// is known before (uniform).
class LabelCounts {
 public:
  /// A loop that no other leads.
  enum Alone { kFirst, kCopy };

  /// One that is true with this probability, and the one before it in its run with that.
  void add(Alone alone, double is_true) { add(counts_[alone], is_true, 1.0); }
  void add_next(double before, double is_true) {
    add(counts_[kAfterFalse], is_true, 1.0 - before);
    add(counts_[kAfterTrue], is_true, before);
  }

  /// log of the probability that just these are true, with those four integrated out
  /// (Beta-binomial).
  double log_evidence() const;

  /// log of the probability that one more is, or is not, where others are as counted: alone, log of
  /// the odds of that, and after one that is or is not.
  double log_share(Alone alone, bool is_true) const { return log_share(counts_[alone], is_true); }
  double log_odds(Alone alone) const { return log_share(alone, true) - log_share(alone, false); }
  double log_next(bool before, bool is_true) const {
    return log_share(counts_[before ? kAfterTrue : kAfterFalse], is_true);
  }

 private:
  using Count = std::array<double, 2>;  // false, true
  enum Led { kAfterFalse = kCopy + 1, kAfterTrue, kKinds };

  static void add(Count& count, double is_true, double weight) {
    count[0] += weight * (1.0 - is_true);
    count[1] += weight * is_true;
  }
  static double log_share(const Count& count, bool is_true);

  std::array<Count, kKinds> counts_{};
};

}  // namespace isotherm::slam::detail
