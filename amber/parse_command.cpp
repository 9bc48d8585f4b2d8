// Reads RUN, EXPECT, COPY and REPEAT.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <optional>

#include "amber/parse.h"

namespace glint::amber {
namespace {

std::optional<Comparator> comparator_named(const std::string& name) {
  const std::map<std::string, Comparator> names{{"EQ", Comparator::Eq},
                                                {"NE", Comparator::Ne},
                                                {"LT", Comparator::Lt},
                                                {"LE", Comparator::Le},
                                                {"GT", Comparator::Gt},
                                                {"GE", Comparator::Ge},
                                                {"EQ_RGB", Comparator::Rgb},
                                                {"EQ_RGBA", Comparator::Rgba},
                                                {"EQ_BUFFER", Comparator::Buffer},
                                                {"RMSE_BUFFER", Comparator::Rmse},
                                                {"EQ_HISTOGRAM_EMD_BUFFER", Comparator::Histogram}};
  const auto found = names.find(name);
  return found == names.end() ? std::nullopt : std::optional(found->second);
}

bool is_number(const Token& token) {
  double value = 0;
  return token.is_word() && parse_real(token.text, value);
}

void parse_run(Parsing& p, Command& command) {
  p.tokens.accept("TIMED_EXECUTION");
  command.pipeline = p.tokens.word("the pipeline");
  const Pipeline& pipeline = p.find(p.script.pipelines, command.pipeline, "pipeline");
  const auto table = [&](const char* kind, std::string& to) {
    if (!p.tokens.accept(kind)) return;
    to = p.tokens.word("the table");
    if (!pipeline.tables.count(to))
      p.wrong(fmt::format("pipeline '{}' has no shader binding table '{}'", pipeline.name, to));
  };
  while (p.tokens.peek().is_word() && !is_number(p.tokens.peek())) {
    const std::string next = p.tokens.peek().text;
    if (next.rfind("DRAW_", 0) == 0) p.unsupported("graphics: " + next);
    if (!pipeline.is_ray_tracing || (next != "RAYGEN" && next != "MISS" && next != "HIT" && next != "CALL"))
      p.unsupported("RUN " + next);
    table("RAYGEN", command.raygen), table("MISS", command.miss), table("HIT", command.hit),
        table("CALL", command.callable);
  }
  if (pipeline.is_ray_tracing && command.raygen.empty()) p.wrong("RAYGEN is missing");
  for (uint32_t& each : command.size) each = p.tokens.number("the size");
}

void parse_tolerances(Parsing& p, Expectation& expect) {
  while (p.tokens.peek().is_word() && !comparator_named(p.tokens.peek().text))
    expect.tolerances.push_back(parse_tolerance(p));
  if (expect.tolerances.empty() || expect.tolerances.size() > 4)
    p.wrong("a tolerance has one to four numbers");
}

void parse_expect(Parsing& p, Command& command) {
  Expectation& expect = command.expect;
  expect.buffer = p.tokens.word("the buffer");
  p.find(p.script.buffers, expect.buffer, "buffer");
  bool has_comparator = false;
  while (p.tokens.peek().is_word()) {
    const std::string word = p.tokens.next().text;
    if (word == "IDX") {
      expect.x = p.tokens.number("the index");
      if (is_number(p.tokens.peek())) expect.y = p.tokens.number("the row");
    } else if (word == "SIZE") {
      expect.width = p.tokens.number("the width"), expect.height = p.tokens.number("the height");
    } else if (word == "TOLERANCE") {
      parse_tolerances(p, expect);
    } else if (const std::optional<Comparator> comparator = comparator_named(word)) {
      expect.comparator = *comparator, has_comparator = true;
      if (*comparator == Comparator::Buffer || *comparator == Comparator::Rmse ||
          *comparator == Comparator::Histogram) {
        expect.other = p.tokens.word("the other buffer");
        p.find(p.script.buffers, expect.other, "buffer");
      } else {
        while (is_number(p.tokens.peek())) expect.values.push_back(p.tokens.next().text);
      }
    } else
      p.unsupported("EXPECT " + word);
  }
  if (!has_comparator) p.wrong("a comparison is missing");
  const bool is_colour = expect.comparator == Comparator::Rgb || expect.comparator == Comparator::Rgba;
  if (is_colour && expect.values.size() != (expect.comparator == Comparator::Rgb ? 3 : 4))
    p.wrong("EQ_RGB takes three numbers and EQ_RGBA takes four");
  if (is_colour && expect.width == 0) p.wrong("SIZE is missing");
  if (expect.other.empty() && expect.values.empty()) p.wrong("the values are missing");
}

void parse_repeat(Parsing& p, Command& command) {
  command.count = uint32_t(p.tokens.integer("the count", 1, 1'000'000));
  p.tokens.end_line();
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends()) {
    if (!parse_command(p, token.text, command.body)) p.unsupported("in REPEAT: " + token.text);
    p.tokens.end_line();
  }
  if (!token.is_word()) p.wrong("END is missing");
}

void parse_copy(Parsing& p, Command& command) {
  command.from = p.tokens.word("the buffer");
  if (!p.tokens.accept("TO")) p.wrong("TO is missing");
  command.to = p.tokens.word("the buffer");
  const Buffer& from = p.find(p.script.buffers, command.from, "buffer");
  const Buffer& to = p.find(p.script.buffers, command.to, "buffer");
  if (command.from == command.to) p.wrong("a buffer cannot be copied to itself");
  if (from.type.name != to.type.name)
    p.wrong(
        fmt::format("'{}' holds {}, but '{}' holds {}", from.name, from.type.name, to.name, to.type.name));
}

}  // namespace

std::pair<double, bool> parse_tolerance(Parsing& p) {
  std::string text = p.tokens.word("the tolerance");
  const bool is_percent = text.ends_with('%');
  if (is_percent) text.pop_back();
  double value = 0;
  if (!parse_real(text, value)) p.wrong(fmt::format("'{}' is not a tolerance", text));
  return {value, is_percent};
}

bool parse_command(Parsing& p, const std::string& name, std::vector<Command>& to) {
  Command command;
  command.where = p.tokens.here();
  if (name == "RUN")
    command.kind = Command::Kind::Run, parse_run(p, command);
  else if (name == "EXPECT")
    command.kind = Command::Kind::Expect, parse_expect(p, command);
  else if (name == "COPY")
    command.kind = Command::Kind::Copy, parse_copy(p, command);
  else if (name == "REPEAT")
    command.kind = Command::Kind::Repeat, parse_repeat(p, command);
  else if (name.rfind("CLEAR", 0) == 0)
    p.unsupported("graphics: " + name);
  else
    return false;
  to.push_back(std::move(command));
  return true;
}

}  // namespace glint::amber
