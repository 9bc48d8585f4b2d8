// Splits GLSL into tokens and computes sizes of macros from the sizes of the macros that they name.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/glsl/token_count.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <utility>

namespace glint::frontend {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

// Reads a text token by token. Comments and lines that continue count as white space.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  // Returns the next token of the present line, or an empty one at the line's end.
  std::string_view next() {
    skip_blanks();
    if (at_ == text_.size() || text_[at_] == '\n') return {};
    const size_t begin = at_++;
    if (is_word(text_[begin]))
      while (at_ < text_.size() && (is_word(text_[at_]) || text_[at_] == '.')) {
        if (text_[at_] == '.' && !std::isdigit(static_cast<unsigned char>(text_[begin]))) break;
        ++at_;
      }
    return text_.substr(begin, at_ - begin);
  }
  // Returns the rest of the present line.
  std::string_view rest() const { return text_.substr(at_, text_.find('\n', at_) - at_); }
  // Goes to the next line. Returns false at the end of the text.
  bool next_line() {
    while (!next().empty()) {
    }
    if (at_ == text_.size()) return false;
    ++at_, ++line_;
    return true;
  }
  int line() const { return line_; }

 private:
  void skip_blanks() {
    while (at_ < text_.size()) {
      const std::string_view left = text_.substr(at_);
      if (left.starts_with("\\\n")) {
        at_ += 2, ++line_;
      } else if (left.starts_with("\\\r\n")) {
        at_ += 3, ++line_;
      } else if (left.starts_with("//")) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (left.starts_with("/*")) {
        const size_t end = std::min(text_.find("*/", at_ + 2), text_.size() - 2) + 2;
        line_ += int(std::count(text_.begin() + long(at_), text_.begin() + long(end), '\n'));
        at_ = end;
      } else if (left[0] != '\n' && std::isspace(static_cast<unsigned char>(left[0]))) {
        ++at_;
      } else {
        return;
      }
    }
  }

  std::string_view text_;
  size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

void TokenCount::Size::add(const Size& other, double times) {
  if (times == 0) return;
  constant += other.constant * times;
  multiples.resize(std::max(multiples.size(), other.multiples.size()));
  for (size_t i = 0; i < other.multiples.size(); ++i)
    if (other.multiples[i] != 0) multiples[i] += other.multiples[i] * times;
}

std::vector<TokenCount::Header> TokenCount::add(const std::string& file, std::string_view text) {
  texts_.emplace_back(text);
  Reader reader(texts_.back());
  std::vector<Header> headers;
  Tokens present;  // of the lines since the last directive
  const auto end_use = [&] {
    if (!present.empty()) uses_.push_back({file, std::move(present)});
    present.clear();
  };
  do {
    Tokens line;
    bool is_include = false;
    for (std::string_view token = reader.next(); !token.empty() && !is_include; token = reader.next()) {
      line.push_back({token, reader.line()});
      is_include = line.size() == 2 && line[0].text == "#" && token == "include";
      if (is_include) {
        const std::string_view rest = reader.rest();
        const size_t begin = rest.find_first_of("\"<");
        const size_t end = begin == rest.npos ? begin : rest.find_first_of("\">", begin + 1);
        if (end != rest.npos)
          headers.push_back({std::string(rest.substr(begin + 1, end - begin - 1)), rest[begin] == '"'});
      }
    }
    if (line.empty() || line[0].text != "#") {
      present.insert(present.end(), line.begin(), line.end());
      continue;
    }
    end_use();
    if (line.size() > 2 && line[1].text == "define") define(line);
  } while (reader.next_line());
  end_use();
  return headers;
}

// Reads `# define NAME(parameters) body`. The parenthesis of parameters follows the name at once.
void TokenCount::define(const Tokens& directive) {
  Definition made;
  size_t body = 3;
  const std::string_view name = directive[2].text;
  if (body < directive.size() && directive[body].text == "(" &&
      directive[body].text.data() == name.data() + name.size()) {
    made.takes_arguments = true;
    for (++body; body < directive.size() && directive[body].text != ")"; ++body)
      if (directive[body].text != ",") made.parameters.push_back(directive[body].text);
    ++body;
  }
  if (body < directive.size()) made.body.assign(directive.begin() + long(body), directive.end());
  macros_[name].push_back(std::move(made));
}

// Computes each macro once.
class TokenCount::Sizes {
 public:
  explicit Sizes(const TokenCount& count) : count_(count) {}

  // Returns the size of the token at `i`, with its arguments, and moves `i` to the last of them.
  Size of_token(const Tokens& tokens, size_t& i, const std::vector<std::string_view>& parameters) {
    const std::string_view word = tokens[i].text;
    if (const auto at = std::find(parameters.begin(), parameters.end(), word); at != parameters.end()) {
      Size out{0, std::vector<double>(parameters.size())};
      out.multiples[size_t(at - parameters.begin())] = 1;
      return out;
    }
    const auto macro = count_.macros_.find(word);
    if (macro == count_.macros_.end()) return {1, {}};
    std::optional<std::vector<Size>> arguments;  // read only for a macro that takes some
    Size most{0, {}};
    for (size_t d = 0; d < macro->second.size(); ++d) {
      const bool takes = macro->second[d].takes_arguments;
      if (takes && (i + 1 == tokens.size() || tokens[i + 1].text != "(") && !arguments) {
        if (most.constant < 1) most.constant = 1;
        continue;
      }
      if (takes && !arguments) arguments = read_arguments(tokens, i, parameters);
      Size size = of_definition(macro->first, d);
      Size all{size.constant, {}};
      if (takes)
        for (size_t a = 0; a < std::min(size.multiples.size(), arguments->size()); ++a)
          all.add((*arguments)[a], size.multiples[a]);
      if (all.constant >= most.constant) most = std::move(all);
    }
    return most;
  }

  Size of(const Tokens& tokens, const std::vector<std::string_view>& parameters) {
    Size all;
    for (size_t i = 0; i < tokens.size(); ++i) all.add(of_token(tokens, i, parameters), 1);
    return all;
  }

 private:
  // Reads arguments up to the parenthesis that closes, and moves `i` there.
  std::vector<Size> read_arguments(const Tokens& tokens, size_t& i,
                                   const std::vector<std::string_view>& parameters) {
    std::vector<Size> out(1);
    int depth = 0;
    for (++i; i < tokens.size(); ++i) {
      const std::string_view text = tokens[i].text;
      depth += text == "(" ? 1 : text == ")" ? -1 : 0;
      if (depth == 0) return out;
      if (depth == 1 && text == "(") continue;
      if (depth == 1 && text == ",")
        out.emplace_back();
      else
        out.back().add(of_token(tokens, i, parameters), 1);
    }
    --i;
    return out;
  }

  Size of_definition(std::string_view name, size_t index) {
    std::vector<Size>& sizes = known_[name];
    const std::vector<Definition>& definitions = count_.macros_.at(name);
    // While a macro is being computed it counts as one token, because a macro does not expand in itself.
    if (sizes.empty()) {
      sizes.assign(definitions.size(), Size{1, {}});
      for (size_t d = 0; d < definitions.size(); ++d) {
        Size size = of(definitions[d].body, definitions[d].parameters);
        known_[name][d] = std::move(size);
      }
    }
    return known_[name][index];
  }

  const TokenCount& count_;
  std::map<std::string_view, std::vector<Size>> known_;
};

void TokenCount::check() const {
  Sizes sizes(*this);
  double all = 0, most = 0;
  SourceLocation where, end;  // of the largest expansion, and where the limit is reached
  std::string_view largest;
  for (const Use& use : uses_)
    for (size_t i = 0; i < use.tokens.size(); ++i) {
      const Token& token = use.tokens[i];
      const double size = sizes.of_token(use.tokens, i, {}).constant;
      if (all <= kMostTokens) end = {use.file, token.line, 0};
      all += size;
      if (size > most) most = size, where = {use.file, token.line, 0}, largest = token.text;
    }
  if (all <= kMostTokens) return;
  const auto amount = [](double n) {
    return n > 1e12 ? std::string("more than a million million") : fmt::format("{:.0f}", n);
  };
  if (most <= 1)
    throw UserError(end,
                    fmt::format("the shader has {} tokens, and may have {:.0f}", amount(all), kMostTokens));
  throw UserError(where,
                  fmt::format("'{}' expands to {} tokens, and a shader may have {:.0f} in all", largest,
                              amount(most), kMostTokens),
                  "look for macros that name each other, or themselves in their arguments");
}

}  // namespace glint::frontend
