// sim/ERRATA.md against the code: comments say "ERRATA row N", and a reader must find that row.
// Rows are numbered without a gap and give a reason, the files that the page names exist, and so do
// the symbols that it names in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace pneuma::sim {
namespace {

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// All matches of an expression, each as its first group.
std::vector<std::string> find_all(const std::string& text, const std::regex& expression) {
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end;
       ++match) {
    found.push_back((*match)[1].str());
  }
  return found;
}

/// The numbers of the headings "## N. Title", in their order.
std::vector<int> rows_of(const std::string& page) {
  std::vector<int> rows;
  std::istringstream lines(page);
  const std::regex heading(R"(## (\d+)\. \S.*)");
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, heading)) rows.push_back(std::stoi(match[1]));
  }
  return rows;
}

struct Citation {
  std::filesystem::path file;
  std::ptrdiff_t line;
  int row;
};

/// "ERRATA row 4", "ERRATA rows 14 and 17", "ERRATA rows 3, 4 and 9", "ERRATA rows 13 to 16", also
/// across the lines of a comment.
std::vector<Citation> citations_of(const std::filesystem::path& file, const std::string& text) {
  static const std::string gap = R"([\s/]+)";
  static const std::string between =
      "(?:," + gap + "(?:and" + gap + ")?|" + gap + "(?:and|to)" + gap + ")";
  static const std::regex citation("ERRATA" + gap + "row(?:" + gap + R"((\d+)|s)" + gap +
                                   R"((\d+(?:)" + between + R"(\d+)*)))");
  static const std::regex number(R"((to)?[\s/]*(\d+))");
  std::vector<Citation> citations;
  for (std::sregex_iterator match(text.begin(), text.end(), citation), end; match != end; ++match) {
    const auto line = 1 + std::count(text.begin(), text.begin() + match->position(), '\n');
    const std::string list = (*match)[1].matched ? (*match)[1] : (*match)[2];
    int last = 0;
    for (std::sregex_iterator item(list.begin(), list.end(), number); item != end; ++item) {
      const int row = std::stoi((*item)[2]);
      const bool is_range = (*item)[1].matched;
      for (int cited = is_range ? last + 1 : row; cited <= row; ++cited) {
        citations.push_back({file, line, cited});
      }
      last = row;
    }
  }
  return citations;
}

std::vector<Citation> citations_of_project() {
  std::vector<Citation> citations;
  for (const char* folder : {"app", "assets", "render", "scenes", "sim", "tests"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(project_folder() / folder)) {
      const std::filesystem::path& file = entry.path();
      if (file.extension() != ".h" && file.extension() != ".cpp") continue;
      if (file.filename() == "errata_test.cpp") continue;  // its examples are no citations
      const std::vector<Citation> found = citations_of(file, read_text(file));
      citations.insert(citations.end(), found.begin(), found.end());
    }
  }
  return citations;
}

/// A symbol that a row's *Where* places in a file.
struct Place {
  std::string symbol;
  std::string file;
};

/// Of "`first` and `A::second` in `sim/a.h` and in `sim/b.cpp`; `sim/c.h`": what stands before " in
/// `FILE`" is named in that file, and in each that follows by " and in ".
std::vector<Place> places_of(const std::string& where) {
  static const std::regex quoted("`([^`]+)`");
  static const std::regex is_file(R"((?:assets|render|scenes|sim|tests)/[\w./]+)");
  static const std::regex in(R"([^`]*\sin\s+)");
  static const std::regex and_in(R"(\s+and\s+in\s+)");
  std::vector<Place> places;
  std::vector<std::string> symbols;
  bool after_file = false;
  for (std::sregex_iterator match(where.begin(), where.end(), quoted), end; match != end; ++match) {
    const std::string between = match->prefix();
    const std::string word = (*match)[1];
    const bool file = std::regex_match(word, is_file);
    if (after_file && !(file && std::regex_match(between, and_in))) symbols.clear();
    if (!file) symbols.push_back(word);
    if (file && std::regex_match(between, in)) {
      for (const std::string& symbol : symbols) places.push_back({symbol, word});
    }
    after_file = file;
  }
  return places;
}

/// The text from "- **Name:**" to the next such entry, row or table of a page, for each of them.
std::vector<std::string> entries_of(const std::string& page, const std::string& name) {
  const std::string mark = "- **" + name + ":**";
  std::vector<std::string> entries;
  for (auto at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
    entries.push_back(page.substr(at, std::min(page.find("\n- ", at), page.find("\n\n", at)) - at));
  }
  return entries;
}

/// Whether a file has a symbol's last name as a whole word.
bool names(const std::string& text, const std::string& symbol) {
  const auto scope = symbol.rfind("::");
  const std::string name = scope == std::string::npos ? symbol : symbol.substr(scope + 2);
  return std::regex_search(text, std::regex("\\b" + name + "\\b"));
}

std::vector<int> cited_rows(const std::string& text) {
  std::vector<int> rows;
  for (const Citation& citation : citations_of("", text)) rows.push_back(citation.row);
  return rows;
}

TEST(Errata, CitationsAreReadInAllTheirForms) {
  using Rows = std::vector<int>;
  EXPECT_EQ(cited_rows("// (ERRATA row 4)."), Rows({4}));
  EXPECT_EQ(cited_rows("/// ERRATA rows 14 and 17: 3 more"), Rows({14, 17}));
  EXPECT_EQ(cited_rows("ERRATA rows 3, 4"), Rows({3, 4}));
  EXPECT_EQ(cited_rows("ERRATA rows 3, 4, and 25. Row 7"), Rows({3, 4, 25}));
  EXPECT_EQ(cited_rows("ERRATA rows 13 to 16 and 2"), Rows({13, 14, 15, 16, 2}));
  EXPECT_EQ(cited_rows("ERRATA row 4, 2 of them"), Rows({4}));
  EXPECT_EQ(cited_rows("the sign of ERRATA row\n/// 2), summed; ERRATA\n  // rows 8 and\n  // 9"),
            Rows({2, 8, 9}));
  EXPECT_EQ(cited_rows("ERRATA.md says"), Rows());
}

TEST(Errata, RowsAreNumberedFromOneWithoutAGap) {
  const std::vector<int> rows = rows_of(read_text(project_folder() / "sim/ERRATA.md"));
  ASSERT_GE(rows.size(), 25U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i], static_cast<int>(i) + 1) << "the heading after row " << i;
  }
}

TEST(Errata, EveryCitedRowExists) {
  const int rows = static_cast<int>(rows_of(read_text(project_folder() / "sim/ERRATA.md")).size());
  const std::vector<Citation> citations = citations_of_project();
  EXPECT_GT(citations.size(), 40U) << "the search for citations finds next to none";
  for (const Citation& citation : citations) {
    EXPECT_TRUE(citation.row >= 1 && citation.row <= rows)
        << citation.file.lexically_relative(project_folder()).string() << ":" << citation.line
        << " cites ERRATA row " << citation.row << "; sim/ERRATA.md has rows 1 to " << rows;
  }
}

TEST(Errata, EveryRowHasAReasonAndAPlace) {
  const std::string page = read_text(project_folder() / "sim/ERRATA.md");
  const std::size_t rows = rows_of(page).size();
  std::size_t start = page.find("\n## 1. ");
  for (std::size_t row = 1; row <= rows; ++row) {
    const std::size_t end = page.find("\n## ", start + 1);
    const std::string text = page.substr(start, end - start);
    for (const char* entry : {"Paper", "Here", "Why", "Where"}) {
      EXPECT_EQ(entries_of(text, entry).size(), 1U) << entry << " of row " << row;
    }
    start = end;
  }
}

TEST(Errata, PlacesAreReadFromALineOfWhere) {
  const auto places = places_of(
      "`a`, `B::c` and `d` in `sim/a.h` and in\n  `sim/b.cpp`; `e` in `sim/c.h`; `sim/d.h`, with "
      "`f`.");
  std::string found;
  for (const auto& [symbol, file] : places) found += symbol + " " + file + ", ";
  EXPECT_EQ(found,
            "a sim/a.h, B::c sim/a.h, d sim/a.h, a sim/b.cpp, B::c sim/b.cpp, d sim/b.cpp, "
            "e sim/c.h, ");
}

TEST(Errata, SymbolsStandInTheFilesThatItNames) {
  std::size_t places = 0;
  for (const std::string& where :
       entries_of(read_text(project_folder() / "sim/ERRATA.md"), "Where")) {
    for (const auto& [symbol, file] : places_of(where)) {
      EXPECT_TRUE(names(read_text(project_folder() / file), symbol)) << symbol << " in " << file;
      ++places;
    }
  }
  EXPECT_GT(places, 80U);
}

TEST(Errata, FilesThatItNamesExist) {
  const std::regex file(R"(`((?:assets|render|scenes|sim|tests)/[\w./]+)`)");
  const auto named = find_all(read_text(project_folder() / "sim/ERRATA.md"), file);
  EXPECT_GT(named.size(), 60U);
  for (const std::string& name : named) {
    EXPECT_TRUE(std::filesystem::exists(project_folder() / name)) << name;
  }
}

}  // namespace
}  // namespace pneuma::sim
