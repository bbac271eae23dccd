#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "framework/models/external/program_simulator.hpp"

namespace twinmap::testing {
namespace {

/// The first block of docs/how-to/use-a-program.md in a language.
std::string readBlock(const std::string& language) {
  std::ifstream file(TWINMAP_SOURCE_DIR "/docs/how-to/use-a-program.md");
  std::stringstream page;
  page << file.rdbuf();
  const std::string text = page.str(), begin = "```" + language + " program\n";
  const std::size_t first = text.find(begin) + begin.size();
  return text.substr(first, text.find("```", first) - first);
}

class DocumentedProgram : public ::testing::Test {
 protected:
  DocumentedProgram() {
    std::string pattern = (std::filesystem::temp_directory_path() / "programs.XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~DocumentedProgram() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& language) const {
    std::ofstream(folder_ / name) << readBlock(language);
  }

  /// a exp(-b t) to the digits that the program writes.
  void expectDecay(const std::vector<std::string>& command) const {
    ModelSpec model;
    for (const char* name : {"a", "b"}) {
      ParameterSpec parameter;
      parameter.name.text = name;
      parameter.bounds.lower = 1.0;
      parameter.bounds.upper = 3.0;
      model.parameters.push_back(parameter);
    }
    OutputSpec output;
    output.name.text = "x";
    output.variable = output.name;
    model.outputs = {output};
    model.simulation.duration = 1.0;
    ProgramSpec program;
    program.command = command;
    program.working_folder = folder_.string();
    model.source = SourceSpec{};
    model.source->program = program;
    ProgramSimulator simulator(model, Eigen::Vector3d(0.0, 0.5, 1.0), 0);
    const Eigen::Matrix2d points = (Eigen::Matrix2d() << 1.5, 2.5, 1.25, 2.75).finished();
    Eigen::MatrixXd responses(3, 2);
    SampleStatus statuses[2];
    simulator.simulate(points, responses, statuses);
    for (int j = 0; j < 2; ++j) {
      ASSERT_TRUE(statuses[j].ok) << statuses[j].reason;
      for (int i = 0; i < 3; ++i) {
        EXPECT_DOUBLE_EQ(responses(i, j), points(0, j) * std::exp(-points(1, j) * 0.5 * i));
      }
    }
  }

  std::filesystem::path folder_;
};

TEST_F(DocumentedProgram, InPythonAnswersAsItSays) {
  write("plant.py", "python");
  expectDecay({"python3", "plant.py"});
}

TEST_F(DocumentedProgram, InCAnswersAsItSays) {
  write("plant.c", "c");
  const std::string plant = (folder_ / "plant").string();
  ASSERT_EQ(std::system(("cc -D_GNU_SOURCE -O1 -o " + plant + " " + plant + ".c -lm").c_str()), 0);
  expectDecay({"./plant"});
}

TEST_F(DocumentedProgram, ForFilesFillsInTemplatesAndReadsWhatACommandWrites) {
  std::ofstream(folder_ / "plant.txt.template") << "{a}\n{b}\n{c}\n";
  std::ofstream(folder_ / "solver.py") << "import math\n"
                                          "a, b, other = open('plant.txt').read().split()\n"
                                          "assert other == '{c}'\n"
                                          "with open('out.csv', 'w') as file:\n"
                                          "    print('time, x', file=file)\n"
                                          "    for i in range(101):\n"
                                          "        print(repr(i / 100), repr(float(a) * math.exp(-float(b) * "
                                          "i / 100)), sep=', ', file=file)\n";
  expectDecay({TWINMAP_SOURCE_DIR "/scripts/twinmap-files", "--template", "plant.txt.template", "--results",
               "out.csv", "--", "python3", "solver.py"});
}

}  // namespace
}  // namespace twinmap::testing
