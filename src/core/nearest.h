// The nearest valid word to a mistyped one.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wisp {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (Damerau
/// 1964, the restricted form); upper and lower case, '-' and '_' count as equal.
inline int edit_distance(std::string_view a, std::string_view b) {
  const auto plain = [](char c) {
    return c == '-' ? '_' : (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
  };
  const std::size_t m = b.size();
  std::vector<int> before(m + 1), above(m + 1), row(m + 1);
  for (std::size_t j = 0; j <= m; ++j) above[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= m; ++j) {
      const bool same = plain(a[i - 1]) == plain(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && plain(a[i - 1]) == plain(b[j - 2]) && plain(a[i - 2]) == plain(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[m];
}

/// The valid word that is nearest to `word`, empty if none is near (more than a third of its letters
/// differ, and it is not a beginning either).
inline std::string nearest(std::string_view word, const std::vector<std::string>& valid) {
  std::string best;
  int least = std::max(1, static_cast<int>(word.size()) / 3) + 1;
  for (const auto& candidate : valid) {
    const int d = edit_distance(word, candidate);
    if (d < least) {
      least = d;
      best = candidate;
    }
  }
  if (best.empty() && word.size() >= 3)  // or the start of a valid word
    for (const auto& candidate : valid)
      if (candidate.starts_with(word)) return candidate;
  return best;
}

/// " did you mean 'x'?" style ending for a mistyped word: nearest valid one, and all valid ones if they are
/// few.
inline std::string suggestion(std::string_view word, const std::vector<std::string>& valid) {
  std::string text;
  if (const std::string best = nearest(word, valid); !best.empty()) text = "; did you mean '" + best + "'?";
  if (!valid.empty() && valid.size() <= 12) {
    text += text.empty() ? "; valid: " : " (valid: ";
    for (std::size_t i = 0; i < valid.size(); ++i) text += (i > 0 ? ", " : "") + valid[i];
    if (text.find('(') != std::string::npos) text += ")";
  }
  return text;
}

}  // namespace wisp
