#pragma once

#include <optional>

#include "framework/experiment/excitation_design_spec.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/sensor_design_spec.hpp"

namespace twinmap {

enum class DesignMethod { kLatinHypercube, kNestedLatinHypercube, kSobol, kUniform };

template <>
struct EnumNames<DesignMethod> {
  static constexpr EnumName<DesignMethod> values[] = {
      {"latin_hypercube", DesignMethod::kLatinHypercube},
      {"nested_latin_hypercube", DesignMethod::kNestedLatinHypercube},
      {"sobol", DesignMethod::kSobol},
      {"uniform", DesignMethod::kUniform},
  };
};

/// A number of samples, or as many as are worth their time. Converts from and to a plain number, which is all
/// that most of its users want.
struct SampleCount {
  SampleCount(int count = 0) : number(count) {}  // NOLINT(google-explicit-constructor)
  static SampleCount makeAutomatic(int most) {
    SampleCount count(most);
    count.automatic = true;
    return count;
  }
  operator int() const { return number; }  // NOLINT(google-explicit-constructor)

  int number;  ///< where it is automatic: the most that may be taken
  bool automatic = false;
};

/// Points in the parameter box.
struct PointSetSpec {
  DesignMethod method = DesignMethod::kLatinHypercube;
  SampleCount samples;
  std::optional<int>
      smallest;  ///< nested_latin_hypercube: Latin at this size and 2, 4, 8 ... times it; default 1
  std::optional<double> time{};  ///< s, that an automatic number of samples may take; default 10
};

template <class Fields>
void describe(Fields& f, PointSetSpec& s) {
  f.optional("method", s.method, "how the samples are spread within the bounds");
  f.optional("samples", s.samples, "number of points, or automatic: as many as are worth their time");
  f.optional("smallest", s.smallest,
             "nested_latin_hypercube: a Latin hypercube at this size and 2, 4, 8 ... times it (default 1)",
             kSampleCount);
  f.rule(!s.smallest || s.method == DesignMethod::kNestedLatinHypercube,
         "must give smallest with 'method: nested_latin_hypercube' only");
  f.optional("time", s.time, "of an automatic number of samples: what they may take (default 10); s",
             kPositive);
  f.rule(!s.time || s.samples.automatic, "must give time with 'samples: automatic' only");
}

struct DesignSpec {
  PointSetSpec train{DesignMethod::kLatinHypercube, SampleCount::makeAutomatic(250), {}};
  PointSetSpec test{DesignMethod::kUniform, 500, {}};
  std::optional<ExcitationDesignSpec> excitation{};  ///< for `twinmap design excitation`
  std::optional<SensorDesignSpec> sensors{};         ///< for `twinmap design sensors`
};

template <class Fields>
void describe(Fields& f, DesignSpec& s) {
  f.optional("train", s.train, "points to train on");
  f.optional("test", s.test, "points to test on");
  f.optional("excitation", s.excitation, "which values of the excitation to design, and for what");
  f.optional("sensors", s.sensors, "which outputs and sample times to choose from, and for what");
  f.rule(!s.test.samples.automatic, "must give the number of test samples");
}

}  // namespace twinmap
