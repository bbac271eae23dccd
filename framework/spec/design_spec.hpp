#pragma once

#include <optional>

#include "framework/spec/fields/fields.hpp"

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

/// Points in the parameter box.
struct PointSetSpec {
  DesignMethod method = DesignMethod::kLatinHypercube;
  int samples = 0;
  std::optional<int>
      smallest;  ///< nested_latin_hypercube: Latin at this size and 2, 4, 8 ... times it; default 1
};

template <class Fields>
void describe(Fields& f, PointSetSpec& s) {
  f.optional("method", s.method, "how the parameter box is sampled");
  f.optional("samples", s.samples, "number of points", kSampleCount);
  f.optional("smallest", s.smallest,
             "nested_latin_hypercube: a Latin hypercube at this size and 2, 4, 8 ... times it (default 1)",
             kSampleCount);
  f.rule(!s.smallest || s.method == DesignMethod::kNestedLatinHypercube,
         "must give smallest with 'method: nested_latin_hypercube' only");
}

struct DesignSpec {
  PointSetSpec train{DesignMethod::kLatinHypercube, 250, {}};
  PointSetSpec test{DesignMethod::kUniform, 500, {}};
};

template <class Fields>
void describe(Fields& f, DesignSpec& s) {
  f.optional("train", s.train, "points to train on");
  f.optional("test", s.test, "points to test on");
}

}  // namespace twinmap
