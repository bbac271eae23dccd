#pragma once

#include <string>

#include "framework/base/files/atomic_file.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {

/// Text that ends elements, closes quotes and means something to LaTeX, wherever it is not escaped.
inline const std::string kHostile =
    "</script><script>alert(1)</script> \"q\" 'a' & 50% $x_1^2$ {\\b} #~ <!-- [x](y)";

inline std::string quoteYaml(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? "''" : std::string(1, c);
  }
  return quoted + "'";
}

inline std::string quoteCsv(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + "\"";
}

/// An experiment with the parameters k and d and the output x.
inline std::string makeExperimentYaml(const std::string& more = "") {
  return "name: cart\ndescription: " + quoteYaml(kHostile) + R"(
parameters:
  k: {bounds: [80, 120], unit: N/m}
  d: {bounds: [0.5, 2], unit: N s/m}
system:
  bodies:
    cart: {mass: 1.2, joint: {type: slider, coordinates: [x]}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
outputs:
  x: {coordinate: x}
simulation: {duration: 1}
features:
  - samples: {outputs: [x], start: 0.5, interval: 0.5, count: 2}
noise:
  stddev: {x: 1e-3}
design:
  train: {samples: 10}
  test: {samples: 3}
)" + more;
}

/// A run's folder made by hand: three test samples, of which sample 1 could not be simulated.
inline void writeRunFolder(const std::filesystem::path& folder, const std::string& more_yaml = "") {
  std::filesystem::create_directories(folder);
  writeTextFile(folder / "resolved.yaml", makeExperimentYaml(more_yaml));
  writeTextFile(folder / "metrics.csv",
                "parameter,unit,lower,upper,bias_pct,sd_pct,mare_pct,coverage95,sd_pct_se,limit_pct,"
                "ratio_to_limit,test_samples\n"
                "k,N/m,80,120,0.125,0.0749123,0.06,0.95,0.0024,0.05,1.498246,2\n"
                "d,N s/m,0.5,2,-0.5,1.25,1.0,0.5,0.1,,,2\n");
  writeTextFile(folder / "predictions.csv",
                "sample,parameter,true,inferred,stddev\n"
                "0,k,100,101,2\n0,d,1,1.5,0.5\n2,k,90,89,1\n2,d,1.5,1.25,0.125\n");
  writeTextFile(folder / "failures.csv",
                "set,sample,k,d,reason\ntest,1,110,0.75," + quoteCsv(kHostile) + "\n");
  writeTextFile(folder / "training.csv",
                "parameter,start,best,nlml,evaluations,noise_only,stop_reason,at_bound,condition,jitter\n"
                "k,0,1,-10.5,20,0,tolerance,length_scale[1] at its upper bound 9,1e5,0\n"
                "k,1,0,-8,25,0,tolerance,,,\n"
                "d,0,1,-3,22,0,tolerance,noise_stddev at its lower bound 1e-05,1e6,0\n");
  writeTextFile(
      folder / "provenance.json",
      R"({"date": "2026-01-02T03:04:05Z", "command": "twinmap run </script>", "seconds": {"simulate": 2},
"warnings": ["1 sample could not be simulated"]})");
}

}  // namespace twinmap
