// What scripts/times compiles to measure how fast a machine compiles. It is never changed: seconds kept in
// last_release.json would compare no longer. The standard library alone, templates and loops.
#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

template <int N>
struct Polynomial {
  static double evaluate(double x) { return x * Polynomial<N - 1>::evaluate(x) + N; }
};
template <>
struct Polynomial<0> {
  static double evaluate(double) { return 1; }
};

template <int N>
double sum_sorted(const std::map<std::string, std::vector<double>>& table) {
  std::vector<std::tuple<double, std::string, int>> rows;
  for (const auto& [name, values] : table)
    for (double value : values) rows.emplace_back(Polynomial<N>::evaluate(value), name, N);
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return std::get<0>(a) < std::get<0>(b); });
  std::stable_partition(rows.begin(), rows.end(),
                        [](const auto& row) { return std::get<1>(row).size() > N; });
  double total = 0;
  for (const auto& row : rows) total += std::get<0>(row);
  return total;
}

template <int... N>
double sum_all(const std::map<std::string, std::vector<double>>& table, std::integer_sequence<int, N...>) {
  return (sum_sorted<N + 1>(table) + ...);
}

double sum_matching(const std::map<std::string, std::vector<double>>& table, const std::string& expression) {
  std::map<std::string, std::vector<double>> chosen;
  for (const auto& [name, values] : table)
    if (std::regex_search(name, std::regex(expression))) chosen[name] = values;
  std::variant<double, std::string, std::function<double()>> result = [&chosen] {
    return sum_all(chosen, std::make_integer_sequence<int, 6>());
  };
  return std::get<2>(result)();
}
