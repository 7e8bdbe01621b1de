/* Reads objects with dimensions, and reports which line is wrong. */
#include "object_file.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace grrl_sim
{

namespace
{

struct Word {
    std::string text;
    size_t column; /* from 1 */
};

struct Line {
    size_t number;
    std::vector<Word> words;
    size_t end_column;
};

std::vector<Word> split(const std::string &line)
{
    std::vector<Word> words;
    size_t i = 0;
    while (i < line.size() && line[i] != '#') {
        size_t end = line.find_first_of(" \t\r#", i);
        end = end == std::string::npos ? line.size() : end;
        if (end > i)
            words.push_back({line.substr(i, end - i), i + 1});
        i = end > i || line[i] == '#' ? end : i + 1;
    }
    return words;
}

class Parser
{
public:
    explicit Parser(std::string path) : path_(std::move(path)) {}

    Result<ObjectSpec> parse(const std::string &text, const ObjectScale &scale)
    {
        std::istringstream stream(text);
        std::string line;
        for (size_t number = 1; std::getline(stream, line) && error_.empty(); number++)
            statement({number, split(line), line.size() + 1}, line);
        if (error_.empty() && !has_term_)
            fail(1, 1,
                 "the file has no term; the first statement must be 'term R(l1, l2)' or similar");
        if (error_.empty()) {
            std::string problem = finish_object(object_, scale);
            if (!problem.empty())
                fail(term_line_, 1, problem);
        }
        return error_.empty() ? Result<ObjectSpec>::good(object_) : Result<ObjectSpec>::bad(error_);
    }

private:
    void fail(size_t line, size_t column, const std::string &message)
    {
        error_ = path_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message;
    }

    void statement(const Line &line, const std::string &text)
    {
        if (line.words.empty())
            return;
        const Word &keyword = line.words[0];
        if (keyword.text == "term")
            term(line, text);
        else if (keyword.text != "link" && keyword.text != "joint")
            fail(line.number, keyword.column,
                 "unknown statement '" + keyword.text + "'; expected term, link or joint");
        else if (!has_term_)
            fail(line.number, keyword.column, "the term must come before links and joints");
        else if (keyword.text == "link")
            link(line);
        else
            joint(line);
    }

    void term(const Line &line, const std::string &text)
    {
        if (has_term_)
            return fail(line.number, line.words[0].column, "a second term; a file has only one");
        if (line.words.size() < 2)
            return fail(line.number, line.end_column, "expected a term such as R(l1, l2)");
        size_t start = line.words[1].column - 1;
        TermPosition position;
        std::string term_text = text.substr(start, text.find('#', start) - start);
        Result<ObjectSpec> object = links_and_joints(term_text, &position);
        if (!object)
            return fail(line.number, start + position.column, object.error);
        object_ = *object.value;
        has_term_ = true;
        term_line_ = line.number;
    }

    bool expect_words(const Line &line, size_t least, size_t most, const std::string &form)
    {
        if (line.words.size() >= least && line.words.size() <= most)
            return true;
        size_t column = line.words.size() > most ? line.words[most].column : line.end_column;
        fail(line.number, column, "expected: " + form);
        return false;
    }

    int link_index(const Line &line, const Word &word)
    {
        std::string known;
        for (size_t i = 0; i < object_.links.size(); i++) {
            if (object_.links[i].name == word.text)
                return static_cast<int>(i);
            known += (i == 0 ? "" : ", ") + object_.links[i].name;
        }
        fail(line.number, word.column, "the term has no link '" + word.text + "'; it has " + known);
        return -1;
    }

    double number(const Line &line, const Word &word, const char *what, double least, double most)
    {
        char *end = nullptr;
        double value = std::strtod(word.text.c_str(), &end);
        if (*end == '\0' && value >= least && value <= most)
            return value;
        if (error_.empty()) {
            std::ostringstream message;
            message << what << " '" << word.text << "' must be a number from " << least << " to "
                    << most;
            fail(line.number, word.column, message.str());
        }
        return least;
    }

    void link(const Line &line)
    {
        if (!expect_words(line, 5, 5, "link NAME length_m width_m mass_kg"))
            return;
        int index = link_index(line, line.words[1]);
        if (index < 0)
            return;
        LinkSpec &spec = object_.links[static_cast<size_t>(index)];
        spec.half_length_m = number(line, line.words[2], "the length", 0.02, 1.0) / 2.0;
        spec.half_width_m = number(line, line.words[3], "the width", 0.01, 1.0) / 2.0;
        spec.mass_kg = number(line, line.words[4], "the mass", 0.01, 10.0);
        set_feature_range(spec);
    }

    void joint(const Line &line)
    {
        if (!expect_words(line, 10, 12,
                          "joint A B lower upper friction anchor_a_x anchor_a_y anchor_b_x "
                          "anchor_b_y [axis [angle]]"))
            return;
        int a = link_index(line, line.words[1]);
        int b = a < 0 ? -1 : link_index(line, line.words[2]);
        if (b < 0)
            return;
        for (JointSpec &candidate : object_.joints)
            if ((candidate.a == a && candidate.b == b) || (candidate.a == b && candidate.b == a))
                return dimensions(line, a, b, candidate);
        fail(line.number, line.words[1].column,
             "the term has no joint between " + line.words[1].text + " and " + line.words[2].text);
    }

    void dimensions(const Line &line, int a, int b, JointSpec &spec)
    {
        bool turns = spec.type == GRRL_REVOLUTE;
        double unit = turns ? radians(1.0) : 1.0;
        double most = turns ? 180.0 : 1.0;
        const std::vector<Word> &w = line.words;
        spec.a = a;
        spec.b = b;
        spec.given = true;
        spec.lower = unit * number(line, w[3], "the lower limit", -most, most);
        spec.upper = unit * number(line, w[4], "the upper limit", -most, most);
        spec.friction = number(line, w[5], "the friction", 0.0, 100.0);
        spec.anchor_a_m = {number(line, w[6], "the anchor", -1.0, 1.0),
                           number(line, w[7], "the anchor", -1.0, 1.0)};
        spec.anchor_b_m = {number(line, w[8], "the anchor", -1.0, 1.0),
                           number(line, w[9], "the anchor", -1.0, 1.0)};
        spec.axis_rad = w.size() > 10 ? radians(number(line, w[10], "the axis", -360, 360)) : 0.0;
        spec.angle_rad = w.size() > 11 ? radians(number(line, w[11], "the angle", -360, 360)) : 0.0;
        if (error_.empty() && spec.lower >= spec.upper)
            fail(line.number, w[4].column, "the upper limit must be above the lower one");
        double middle = (spec.lower + spec.upper) / 2.0;
        double part = (spec.upper - spec.lower) / 4.0;
        spec.initial_lower = middle - part;
        spec.initial_upper = middle + part;
    }

    std::string path_;
    std::string error_;
    ObjectSpec object_;
    bool has_term_ = false;
    size_t term_line_ = 1;
};

} // namespace

Result<ObjectSpec> object_from_file_text(const std::string &text, const std::string &path,
                                         const ObjectScale &scale)
{
    return Parser(path).parse(text, scale);
}

Result<ObjectSpec> object_from_file(const std::string &path, const ObjectScale &scale)
{
    std::ifstream file(path);
    if (!file)
        return Result<ObjectSpec>::bad(path + ": cannot be read; expected a file of dimensions, a "
                                              "chain such as RPR or a term such as R(l1, l2)");
    std::ostringstream text;
    text << file.rdbuf();
    return object_from_file_text(text.str(), path, scale);
}

} // namespace grrl_sim
