/* report.cpp: makes the page with pictures and tables. */
#include "report.hpp"

#include <sstream>

#include "claims.hpp"
#include "files.hpp"
#include "results.hpp"

namespace grrl_experiment
{

namespace
{

std::string escaped(const std::string &text)
{
    std::string result;
    for (char c : text)
        if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '&')
            result += "&amp;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    return result;
}

std::string base64(const std::string &bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        size_t left = bytes.size() - i < 3 ? bytes.size() - i : 3;
        for (size_t k = 0; k < 3; k++)
            group = group << 8 | (k < left ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; k++)
            text += k <= left ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string table_of(const Plan &plan, const Figure &figure,
                     const std::vector<Experiments> &results)
{
    std::ostringstream html;
    std::vector<Range> columns = ranges(plan.curves[figure.curves[0]].trials());
    html << "<table>\n<tr><th>trials</th>";
    for (const Range &column : columns)
        html << "<th>" << column.label << "</th>";
    html << "<th>at the cap</th></tr>\n";
    for (size_t c : figure.curves) {
        Experiments rows = shown(figure, results, c);
        html << "<tr><td>" << escaped(curve_label(plan.curves[c], false)) << "</td>";
        for (const Range &column : columns)
            html << "<td>" << mean_text(pushes(rows, column.first, column.last), "&plusmn;")
                 << "</td>";
        char share[20];
        (void)std::snprintf(share, sizeof share, "%.1f%%",
                            100.0 * capped(rows, 1, plan.curves[c].trials()));
        html << "<td>" << share << "</td></tr>\n";
    }
    std::vector<Experiments> rules = every_rule(plan, figure, results);
    if (!rules.empty()) {
        html << "<tr><td>every rule</td>";
        for (const Range &column : columns)
            html << "<td>" << means_text(rules, column.first, column.last) << "</td>";
        html << "<td></td></tr>\n";
    }
    html << "</table>\n";
    return html.str();
}

const char *caption_of(Figure::Kind kind)
{
    switch (kind) {
    case Figure::Kind::CURVES:
        return "<p>Lines: means over neighbouring trials with their intervals; points: means of "
               "one "
               "trial. In a transfer, dashed lines are without pretraining.</p>\n";
    case Figure::Kind::ROWS:
        return "<p>Means with their intervals over the first five trials (hollow) and the last ten "
               "(filled).</p>\n";
    case Figure::Kind::MATRIX:
        break;
    }
    return "<p>Paired differences; * marks those beyond their intervals.</p>\n";
}

bool is_used(const Plan &plan, const Policy &policy)
{
    for (const Curve &curve : plan.curves)
        if (curve.policy == &policy)
            return true;
    return false;
}

const char *const head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>grrl experiments</title><style>
body { font: 16px/1.5 sans-serif; color: #222; max-width: 960px; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0; font-variant-numeric: tabular-nums }
th, td { text-align: right; padding: .2em .8em; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left }
pre { background: #f4f4f4; padding: .6em; overflow: auto } img { width: 100% }
</style></head><body>
<h1>Pushes until the structure is known</h1>
)";

} // namespace

std::string report_html(const Options &options, const Folder &folder, const Plan &plan,
                        const std::vector<Experiments> &results)
{
    std::ostringstream html;
    html << head << "<pre>" << escaped(options.command) << "</pre>\n<p>"
         << experiment_seeds(options).size()
         << " experiments for each curve, each starting without experience; means with 95% "
            "intervals (t "
            "distribution over experiments). A trial ends when the supervisor sees the true "
            "structure, or after "
         << options.cap << " pushes.</p>\n";
    for (const Figure &figure : plan.figures) {
        html << "<h2>" << escaped(figure.title) << "</h2>\n";
        std::optional<std::string> picture = read_file(folder.path(figure.name + ".svg"));
        if (picture)
            html << "<img alt=\"" << escaped(figure.title) << "\" src=\"data:image/svg+xml;base64,"
                 << base64(*picture) << "\">\n"
                 << caption_of(figure.kind);
        html << (figure.kind == Figure::Kind::MATRIX
                     ? "<pre>" + escaped(text_table(plan, figure, results)) + "</pre>\n"
                     : table_of(plan, figure, results));
    }
    std::string claims = claims_table(plan, results);
    if (!claims.empty())
        html << "<h2>Claims</h2>\n<pre>" << escaped(claims) << "</pre>\n";
    html << "<h2>Policies</h2>\n<table>\n";
    for (const auto *policies_of : {&policies(), &ablations()})
        for (const Policy &policy : *policies_of)
            if (is_used(plan, policy))
                html << "<tr><td>" << policy.name << "</td><td style=\"text-align:left\">"
                     << escaped(policy.text) << "</td></tr>\n";
    html << "</table>\n</body></html>\n";
    return html.str();
}

} // namespace grrl_experiment
