// Reads scripts in sections, which are Amber's older language (VkScript), and turns their compute commands
// into buffers and commands of a Script.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <regex>

#include "amber/parse.h"
#include "isa/descriptors.h"

namespace glint::amber {
namespace {

constexpr const char* kPushConstants = "push constants";

struct Section {
  std::string title, text;  // begins with empty lines, so that its line numbers are the script's
};

std::vector<Section> split(const std::string& script) {
  std::vector<Section> out;
  size_t line = 0;
  for (size_t at = 0; at < script.size(); ++line) {
    const size_t end = std::min(script.find('\n', at), script.size());
    std::string text = script.substr(at, end - at);
    if (text.size() > 1 && text[0] == '[' && text[1] != '[')
      out.push_back({text.substr(1, std::max<size_t>(text.find(']'), 1) - 1), std::string(line + 1, '\n')});
    else if (!out.empty())
      out.back().text += text + '\n';
    at = end + 1;
  }
  return out;
}

// Returns the type of a name such as "u16vec3", "mat2x4" or "int8_t" by way of Amber's name for it.
std::optional<Type> type_of(const std::string& name) {
  std::smatch m;
  if (std::regex_match(name, m, std::regex("(u?int(?:8|16|64))_t|float16_t")))
    return type_named(m[1].matched ? m[1].str() : "float16");
  if (name == "int" || name == "uint") return type_named(name + "32");
  if (name == "float" || name == "double") return type_named(name);
  if (!std::regex_match(name, m, std::regex("(|d|f16|[iu](?:|8|16|64))(vec|mat)([234])(x[234])?")))
    return std::nullopt;
  const std::string prefix = m[1].str(), size = m[3].str();
  const bool is_integer = prefix[0] == 'i' || prefix[0] == 'u';
  const std::string bits = is_integer && prefix.size() > 1 ? prefix.substr(1) : "32";
  const std::string scalar = prefix.empty()    ? "float"
                             : prefix == "d"   ? "double"
                             : prefix == "f16" ? "float16"
                                               : (prefix[0] == 'u' ? "uint" : "int") + bits;
  if (m[2] == "vec") return m[4].matched ? std::nullopt : type_named("vec" + size + "<" + scalar + ">");
  return is_integer
             ? std::nullopt
             : type_named("mat" + size + (m[4].matched ? m[4].str() : "x" + size) + "<" + scalar + ">");
}

Layout parse_type(Parsing& p, bool std140) {
  const std::string name = p.tokens.word("the data type");
  const std::optional<Type> type = type_of(name);
  if (!type) p.wrong(fmt::format("there is no data type '{}'", name));
  return lay_out(*type, std140);
}

// Returns a place, written "3" or "1:3", as the name of its buffer.
std::string parse_place(Parsing& p) {
  const std::string text = p.tokens.word("the binding");
  const size_t colon = text.find(':');
  int64_t set = 0, binding = 0;
  const bool is_good = (colon == std::string::npos || parse_integer(text.substr(0, colon), set)) &&
                       parse_integer(colon == std::string::npos ? text : text.substr(colon + 1), binding) &&
                       set >= 0 && set < isa::kMaxSets && binding >= 0 && binding < isa::kMaxBindings;
  if (!is_good) p.wrong(fmt::format("'{}' is not a binding", text));
  return fmt::format("{}:{}", set, binding);
}

class Sections {
 public:
  Sections(Script& script, const std::string& path) : script_(script), path_(path) {}

  void run(const std::vector<Section>& sections) {
    for (const Section& section : sections) add_shader(section);
    for (const Section& section : sections) {
      Parsing p{Tokens(section.text, path_), script_};
      if (section.title == "require" || section.title == "test") parse_lines(p, section.title == "test");
    }
    for (auto& [name, pipeline] : script_.pipelines)
      for (const auto& [buffer, binding] : bindings_) pipeline.bindings.push_back(binding);
  }

 private:
  void add_shader(const Section& section) {
    Parsing p{Tokens(section.text, path_), script_};
    const std::map<std::string, Language> languages{{"compute shader", Language::Glsl},
                                                    {"compute shader spirv", Language::SpirvText},
                                                    {"compute shader spirv hex", Language::SpirvHex}};
    for (const char* quiet : {"require", "test", "comment"})
      if (section.title == quiet) return;
    const auto language = languages.find(section.title);
    if (language == languages.end())
      p.unsupported(fmt::format("graphics or unknown: section [{}]", section.title));
    Shader& shader = p.declare(script_.shaders, "compute", "shader");
    shader.name = "compute", shader.stage = isa::Stage::Compute, shader.language = language->second,
    shader.path = path_;
    const size_t lines = section.text.find_first_not_of('\n');
    const std::string text = lines == std::string::npos ? "" : section.text.substr(lines);
    shader.text = shader.language == Language::SpirvHex ? text : at_line(text, int(lines) + 1);
  }

  void parse_lines(Parsing& p, bool is_test) {
    for (Token token = p.tokens.next_after_line_ends(); token.is_word();
         token = p.tokens.next_after_line_ends()) {
      if (is_test)
        parse_test(p, token.text);
      else if (token.text == "fence_timeout")
        p.tokens.number("the time");
      else if (token.text == "framebuffer" || token.text == "depthstencil" || token.text == "fbsize")
        p.unsupported("graphics: " + token.text);
      else
        script_.features.insert(token.text);
      p.tokens.end_line();
    }
  }

  void parse_test(Parsing& p, const std::string& name) {
    if (name == "compute")
      parse_compute(p);
    else if (name == "ssbo")
      parse_storage(p);
    else if (name == "uniform")
      parse_uniform(p);
    else if (name == "probe" && p.tokens.accept("ssbo"))
      parse_probe(p);
    else if (name == "tolerance") {
      tolerances_.clear();
      while (p.tokens.peek().is_word()) tolerances_.push_back(parse_tolerance(p));
      if (tolerances_.empty() || tolerances_.size() > 4) p.wrong("a tolerance has one to four numbers");
    } else
      p.unsupported("graphics or unknown: " + name);
  }

  Command& add(Parsing& p, Command::Kind kind) {
    Command& command = script_.commands.emplace_back();
    command.kind = kind, command.where = p.tokens.here();
    return command;
  }

  void parse_compute(Parsing& p) {
    if (p.tokens.accept("entrypoint")) {
      entry_ = p.tokens.word("the entry point");
      return;
    }
    p.find(script_.shaders, "compute", "shader");
    Command& command = add(p, Command::Kind::Run);
    command.pipeline = "compute " + entry_;
    for (uint32_t& each : command.size) each = p.tokens.number("the size");
    Pipeline& pipeline = script_.pipelines[command.pipeline];
    if (!pipeline.name.empty()) return;
    pipeline.name = command.pipeline, pipeline.where = command.where;
    Attachment attachment;
    attachment.shader = "compute", attachment.entry = entry_, attachment.stage = isa::Stage::Compute;
    pipeline.shaders.push_back(attachment);
  }

  // Returns the buffer of that name and makes it at least `bytes` long.
  Buffer& buffer(Parsing& p, const std::string& name, BindKind kind, uint64_t bytes) {
    if (bytes > kMostBytes) p.wrong(fmt::format("buffer {} has more than {} bytes", name, kMostBytes));
    Buffer& out = script_.buffers[name];
    if (out.name.empty()) {
      out.name = name, out.where = p.tokens.here();
      out.type = *type_named("uint8"), out.layout = lay_out(out.type, false);
      Binding& binding = bindings_[name];
      binding.kind = kind, binding.names = {name}, binding.where = out.where;
      const size_t colon = name.find(':');
      if (colon != std::string::npos)
        binding.set = uint32_t(std::stoul(name)),
        binding.binding = uint32_t(std::stoul(name.substr(colon + 1)));
    }
    if (bindings_[name].kind != kind) p.wrong(fmt::format("buffer {} has another kind", name));
    if (out.bytes.size() < bytes) out.bytes.resize(bytes);
    out.elements = out.bytes.size();
    return out;
  }

  // Reads a write: TYPE OFFSET VALUES.
  void parse_write(Parsing& p, const std::string& name, BindKind kind) {
    Command& command = add(p, Command::Kind::Write);
    const Layout layout = parse_type(p, kind == BindKind::Uniform);
    command.to = name, command.offset = p.tokens.number("the offset");
    const size_t each = layout.slots.size();
    size_t count = 0;
    for (; p.tokens.peek().is_word(); ++count) {
      const Slot& slot = layout.slots[count % each];
      const size_t at = count / each * layout.stride + slot.offset;
      command.bytes.resize(std::max(command.bytes.size(), at + bytes_of(slot.scalar)));
      const std::string text = p.tokens.next().text;
      if (!put(slot.scalar, text, command.bytes.data() + at))
        p.wrong(fmt::format("'{}' is not a number of this type", text));
    }
    if (count == 0 || count % each)
      p.wrong(fmt::format("found {} values, but the type needs a multiple of {}", count, each));
    buffer(p, name, kind, uint64_t{command.offset} + command.bytes.size());
  }

  void parse_storage(Parsing& p) {
    const std::string name = parse_place(p);
    if (p.tokens.accept("subdata")) return parse_write(p, name, BindKind::Storage);
    buffer(p, name, BindKind::Storage, p.tokens.number("the size"));
  }

  void parse_uniform(Parsing& p) {
    if (!p.tokens.accept("ubo")) return parse_write(p, kPushConstants, BindKind::PushConstants);
    const std::string name = parse_place(p);
    parse_write(p, name, BindKind::Uniform);
  }

  void parse_probe(Parsing& p) {
    const std::map<std::string, Comparator> signs{
        {"==", Comparator::Eq}, {"!=", Comparator::Ne}, {"<", Comparator::Lt}, {"<=", Comparator::Le},
        {">", Comparator::Gt},  {">=", Comparator::Ge}, {"~=", Comparator::Eq}};
    Command& command = add(p, Command::Kind::Expect);
    Expectation& expect = command.expect;
    expect.as = parse_type(p, false);
    expect.buffer = parse_place(p);
    p.find(script_.buffers, expect.buffer, "buffer");
    expect.x = p.tokens.number("the offset");
    const std::string sign = p.tokens.word("the comparison");
    const auto found = signs.find(sign);
    if (found == signs.end()) p.wrong(fmt::format("there is no comparison '{}'", sign));
    expect.comparator = found->second;
    if (sign == "~=") expect.tolerances = tolerances_;
    while (p.tokens.peek().is_word()) expect.values.push_back(p.tokens.next().text);
    if (expect.values.empty()) p.wrong("the values are missing");
  }

  Script& script_;
  const std::string path_;
  std::string entry_ = "main";
  std::vector<std::pair<double, bool>> tolerances_;
  std::map<std::string, Binding> bindings_;  // by name of the buffer
};

}  // namespace

bool has_sections(const std::string& text) {
  return !split(text).empty();
}

void parse_sections(Script& script, const std::string& text) {
  Sections(script, script.path).run(split(text));
}

}  // namespace glint::amber
