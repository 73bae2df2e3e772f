// The XML that CI servers read as test results. There is no standard; the elements and attributes used here are
// those that every reader knows: testsuites, testsuite, testcase, failure, error, and their names, counts and
// times.

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sim_clock/scenario/report.hpp"

namespace ltsim {
namespace {

/// With each byte that is no part of UTF-8 replaced by U+FFFD.
std::string as_utf8(std::string_view text) {
  using nlohmann::json;
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

std::string failing_case(const ScenarioReport& report, std::size_t index) {
  const Failure& failure = report.explored.failures[index];
  const std::string name =
      index == 0 ? std::string{report.scenario} : fmt::format("{}, failure {}", report.scenario, index + 1);
  return fmt::format(
      "    <testcase name=\"{0}\" classname=\"{1}\">\n"
      "      <failure type=\"{2}\" message=\"{3}\">{4}</failure>\n"
      "    </testcase>\n",
      as_xml(name), as_xml(report.scenario), to_string(failure.outcome.kind), as_xml(failure.outcome.message),
      as_xml(describe(failure, report.strategy)));
}

std::string error_case(const ScenarioReport& report) {
  return fmt::format(
      "    <testcase name=\"{0}, error\" classname=\"{0}\">\n"
      "      <error type=\"error\" message=\"{1}\"/>\n"
      "    </testcase>\n",
      as_xml(report.scenario), as_xml(*report.error));
}

std::string suite_of(const ScenarioReport& report) {
  std::string cases;
  for (std::size_t i = 0; i < report.explored.failures.size(); ++i) cases += failing_case(report, i);
  if (report.error) cases += error_case(report);
  if (cases.empty()) {
    cases = fmt::format("    <testcase name=\"{0}\" classname=\"{0}\" time=\"{1:.3f}\"/>\n",
                        as_xml(report.scenario), report.explored.seconds);
  }
  const std::size_t failures = report.explored.failures.size();
  const std::size_t errors = report.error ? 1 : 0;
  return fmt::format(
      "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\">\n{}  "
      "</testsuite>\n",
      as_xml(report.scenario), std::max<std::size_t>(failures + errors, 1), failures, errors,
      report.explored.seconds, cases);
}

}  // namespace

std::string as_xml(std::string_view text) {
  std::string xml;
  for (const char c : as_utf8(text)) {
    switch (c) {
      case '<':
        xml += "&lt;";
        break;
      case '>':  // "]]>" is not allowed in an element
        xml += "&gt;";
        break;
      case '&':
        xml += "&amp;";
        break;
      case '"':
        xml += "&quot;";
        break;
      case '\'':
        xml += "&apos;";
        break;
      case '\n':  // as it stands a reader would take it for a blank in an attribute
        xml += "&#10;";
        break;
      case '\t':
        xml += "&#9;";
        break;
      default:
        xml += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return xml;
}

std::string to_junit(const std::vector<ScenarioReport>& reports) {
  std::string suites;
  for (const ScenarioReport& report : reports) suites += suite_of(report);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n" + suites + "</testsuites>\n";
}

}  // namespace ltsim
