/* report_svg.c: the answer as a picture. */
#include "report.h"

#include <string.h>

enum {
    WIDTH = 900,
    MARGIN = 40,
    LINE = 20,      /* of the legend */
    LETTERS = 100,  /* in one line of it */
    SHORTEST = 200, /* limits for the sides of the drawing, whatever the extent of the features */
    LONGEST = 900,
    ELLIPSE_SIGMAS = 2
};

/* Wong's palette for colour-blind readers, its yellow darkened, and three more. */
static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                      "#56b4e9", "#7a5195", "#8c564b", "#b5a300", "#17807e"};

enum { N_COLOURS = sizeof colours / sizeof colours[0] };

/* From the world to the page. */
struct page {
    FILE *file;
    double scale;
    double left; /* world coordinates of the left and the upper edge of the drawing */
    double top;
    double y_sign;
    double height; /* of the drawing, margins included */
};

static const char *colour_of(unsigned body)
{
    return colours[body % N_COLOURS];
}

static double page_x(const struct page *page, double x)
{
    return MARGIN + (x - page->left) * page->scale;
}

static double page_y(const struct page *page, double y)
{
    return MARGIN + (y - page->top) * page->y_sign * page->scale;
}

static struct page fit_page(FILE *file, const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    double low[2] = {0.0, 0.0};
    double high[2] = {0.0, 0.0};
    for (unsigned i = 0; i < model->n_features; i++) {
        double at[2] = {(double)model->feature_m[i].x, (double)model->feature_m[i].y};
        for (int k = 0; k < 2; k++) {
            low[k] = i == 0 || at[k] < low[k] ? at[k] : low[k];
            high[k] = i == 0 || at[k] > high[k] ? at[k] : high[k];
        }
    }
    double wide = high[0] - low[0] > 1e-9 ? high[0] - low[0] : 1e-9;
    double tall = high[1] - low[1];
    struct page page = {.file = file, .left = low[0], .y_sign = report->y_down ? 1.0 : -1.0};
    page.scale = (WIDTH - 2 * MARGIN) / wide;
    if (tall * page.scale > LONGEST)
        page.scale = LONGEST / tall;
    page.left -= ((WIDTH - 2 * MARGIN) / page.scale - wide) / 2.0; /* in the middle */
    page.top = report->y_down ? low[1] : high[1];
    page.height = tall * page.scale + 2 * MARGIN;
    page.height = page.height > SHORTEST ? page.height : SHORTEST;
    return page;
}

static void draw_features(const struct page *page, const struct grrl_model *model)
{
    for (unsigned i = 0; i < model->n_features; i++) {
        unsigned body = model->feature_body[i];
        double x = page_x(page, (double)model->feature_m[i].x);
        double y = page_y(page, (double)model->feature_m[i].y);
        if (body < model->n_bodies)
            (void)fprintf(page->file,
                          "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\" "
                          "stroke=\"white\"/>\n",
                          x, y, colour_of(body));
        else if (body == GRRL_FEATURE_BACKGROUND)
            (void)fprintf(page->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"#bbb\"/>\n",
                          x, y);
        else
            (void)fprintf(page->file,
                          "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"none\" "
                          "stroke=\"#888\"/>\n",
                          x, y);
    }
}

static void draw_pivot(const struct page *page, const struct grrl_joint *joint)
{
    float major;
    float minor;
    struct grrl_vec2 axis;
    grrl_principal_axes(joint->point_cov_m2[0], joint->point_cov_m2[1], joint->point_cov_m2[2],
                        &major, &minor, &axis);
    double x = page_x(page, (double)joint->point_m.x);
    double y = page_y(page, (double)joint->point_m.y);
    double long_radius =
        ELLIPSE_SIGMAS * (double)grrl_sqrt(major > 0.0f ? major : 0.0f) * page->scale;
    double short_radius =
        ELLIPSE_SIGMAS * (double)grrl_sqrt(minor > 0.0f ? minor : 0.0f) * page->scale;
    double degrees = (double)grrl_atan2(axis.y, axis.x) * page->y_sign * 180.0 / (double)GRRL_PI;
    (void)fprintf(page->file,
                  "<ellipse rx=\"%.2f\" ry=\"%.2f\" transform=\"translate(%.1f %.1f) "
                  "rotate(%.1f)\" fill=\"#000\" fill-opacity=\"0.12\" stroke=\"#222\"/>\n",
                  long_radius, short_radius, x, y, degrees);
    (void)fprintf(page->file,
                  "<path d=\"M%.1f %.1fh12m-6 -6v12\" stroke=\"#222\" stroke-width=\"2\"/>\n",
                  x - 6.0, y);
}

static void draw_axis(const struct page *page, const struct grrl_model *model,
                      const struct grrl_joint *joint)
{
    double reach = 0.6 * (double)(model->body[joint->a].length_m + model->body[joint->b].length_m);
    double x = (double)joint->point_m.x;
    double y = (double)joint->point_m.y;
    double dx = reach * (double)joint->axis.x;
    double dy = reach * (double)joint->axis.y;
    (void)fprintf(page->file,
                  "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#222\" "
                  "stroke-width=\"2\" stroke-dasharray=\"8 5\"/>\n",
                  page_x(page, x - dx), page_y(page, y - dy), page_x(page, x + dx),
                  page_y(page, y + dy));
}

static void draw_names(const struct page *page, const struct grrl_model *model)
{
    for (unsigned i = 0; i < model->n_bodies; i++)
        (void)fprintf(page->file,
                      "<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\" stroke=\"white\" "
                      "stroke-width=\"4\" paint-order=\"stroke\" font-weight=\"bold\">f%u</text>\n",
                      page_x(page, (double)model->body[i].centroid_m.x) + 8.0,
                      page_y(page, (double)model->body[i].centroid_m.y) - 8.0, colour_of(i),
                      (unsigned)model->body[i].number);
}

/* The & of a conjunction is markup in SVG. */
static void write_escaped(FILE *file, const char *text, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (text[i] == '&')
            (void)fputs("&amp;", file);
        else
            (void)fputc(text[i], file);
}

/* Writes the term, broken at spaces, or only counts its lines if file is NULL; returns the number
 * of lines. */
static unsigned write_term(FILE *file, const char *term, double y)
{
    unsigned lines = 0;
    for (const char *at = term; *at != '\0'; lines++) {
        size_t n = strlen(at);
        if (n > LETTERS) {
            n = LETTERS;
            while (n > LETTERS / 2 && at[n - 1] != ' ')
                n--;
        }
        if (file != NULL) {
            (void)fprintf(file,
                          "<text x=\"%d\" y=\"%.0f\" font-family=\"monospace\" "
                          "font-size=\"13\">",
                          MARGIN, y + LINE * (double)lines);
            write_escaped(file, at, n);
            (void)fputs("</text>\n", file);
        }
        at += n;
    }
    return lines;
}

static void write_legend(const struct page *page, const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    double y = page->height + LINE;
    y += LINE * write_term(page->file, report->term, y) + 4.0;
    for (unsigned i = 0; i < model->n_bodies; i++, y += LINE)
        (void)fprintf(page->file,
                      "<circle cx=\"%d\" cy=\"%.0f\" r=\"5\" fill=\"%s\"/><text x=\"%d\" "
                      "y=\"%.0f\">f%u: %u features</text>\n",
                      MARGIN + 5, y - 5.0, colour_of(i), MARGIN + 18, y,
                      (unsigned)model->body[i].number, (unsigned)model->body[i].n_features);
    for (unsigned i = 0; i < model->n_joints; i++, y += LINE) {
        const struct grrl_joint *joint = &model->joint[i];
        (void)fprintf(
            page->file, "<text x=\"%d\" y=\"%.0f\">%s f%u \xe2\x80\x93 f%u: %s %.3f</text>\n",
            MARGIN, y, joint->type == GRRL_REVOLUTE ? "+" : "\xe2\x95\x8c",
            (unsigned)model->body[joint->a].number, (unsigned)model->body[joint->b].number,
            joint->type == GRRL_REVOLUTE ? "revolute" : "prismatic", (double)joint->probability);
    }
    (void)fprintf(page->file,
                  "<text x=\"%d\" y=\"%.0f\" fill=\"#666\">grey: background; circles: unassigned; "
                  "ellipses: two standard deviations of a pivot</text>\n",
                  MARGIN, y);
}

void grrl_report_svg(FILE *file, const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    struct page page = fit_page(file, report);
    double height = page.height + LINE * (2.0 + write_term(NULL, report->term, 0.0) +
                                          model->n_bodies + model->n_joints);
    (void)fprintf(file,
                  "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%.0f\" "
                  "viewBox=\"0 0 %d %.0f\" font-family=\"sans-serif\" font-size=\"14\" "
                  "fill=\"#222\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                  (int)WIDTH, height, (int)WIDTH, height);
    draw_features(&page, model);
    for (unsigned i = 0; i < model->n_joints; i++)
        if (model->joint[i].type == GRRL_REVOLUTE)
            draw_pivot(&page, &model->joint[i]);
        else
            draw_axis(&page, model, &model->joint[i]);
    draw_names(&page, model);
    write_legend(&page, report);
    (void)fputs("</svg>\n", file);
}
