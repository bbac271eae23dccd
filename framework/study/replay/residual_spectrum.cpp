#include "framework/study/replay/residual_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

ResidualSpectrum calcResidualSpectrum(const VectorXd& times, const VectorXd& residual) {
  constexpr Index kMaxFrequencies = 400;  // a curve of as many points is as fine as a page shows
  const Index n = times.size();
  const Index count = std::min(kMaxFrequencies, n / 2);
  const double mean_step = (times[n - 1] - times[0]) / static_cast<double>(n - 1);
  const double highest = 0.5 / mean_step;
  ResidualSpectrum spectrum{VectorXd(count), VectorXd(count)};
  for (Index k = 0; k < count; ++k) {
    const double frequency = highest * static_cast<double>(k + 1) / static_cast<double>(count);
    std::complex<double> sum = 0.0;
    for (Index i = 0; i < n; ++i) {
      sum += residual[i] * std::polar(1.0, -2.0 * M_PI * frequency * times[i]);
    }
    spectrum.frequency[k] = frequency;
    spectrum.power[k] = std::norm(sum) / static_cast<double>(n);
  }
  return spectrum;
}

}  // namespace twinmap
