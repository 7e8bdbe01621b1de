/* The readers of grrl-perceive: what they take, and where they say what is wrong. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "handle.h"
#include "tracks.h"

static FILE *file_of(const char *text, size_t length)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, length, file), length);
    rewind(file);
    return file;
}

static bool read_text(const char *text, struct grrl_tracks *tracks, struct grrl_tracks_error *error)
{
    FILE *file = file_of(text, strlen(text));
    bool good = grrl_tracks_read_csv(file, "f", tracks, error);
    assert_int_equal(fclose(file), 0);
    return good;
}

static void test_any_order(void **state)
{
    (void)state;
    struct grrl_tracks tracks;
    struct grrl_tracks_error error;
    assert_true(read_text("\xef\xbb\xbfy , name,visible,point,frame,x\r\n"
                          "2.5,\"a b\",1,-7,10,1.5\r\n"
                          "\r\n"
                          " 8e-1, ,1, 3 ,10,-4\n"
                          "9,,1,3,2,6\n"
                          "nonsense,,0,-7,2,\n",
                          &tracks, &error));
    assert_int_equal(tracks.n_frames, 2);
    assert_int_equal(tracks.n_points, 3);
    assert_false(tracks.in_pixels);
    assert_int_equal(grrl_tracks_count_ids(&tracks), 2);
    assert_int_equal(tracks.frame[0].n, 1);
    assert_false(tracks.frame[0].pushing);
    assert_int_equal(tracks.id[0], 3);
    assert_true(tracks.x[0] == 6.0f && tracks.y[0] == 9.0f);
    assert_int_equal(tracks.frame[1].first, 1);
    assert_int_equal(tracks.frame[1].n, 2);
    assert_true(tracks.frame[1].pushing);
    assert_int_equal(tracks.id[1], -7);
    assert_true(tracks.x[1] == 1.5f && tracks.y[1] == 2.5f);
    assert_true(tracks.x[2] == -4.0f && tracks.y[2] == 0.8f);
    grrl_tracks_free(&tracks);
}

static void test_pixels_and_no_end_of_line(void **state)
{
    (void)state;
    struct grrl_tracks tracks;
    struct grrl_tracks_error error;
    assert_true(read_text("frame,point,x_px,y_px,truth_group\n0,1,2,3,4", &tracks, &error));
    assert_true(tracks.in_pixels);
    assert_int_equal(tracks.n_points, 1);
    grrl_tracks_free(&tracks);
}

static const struct {
    const char *text;
    const char *expected;
} wrong[] = {
    {"", "f:1:1: the file ends here: the header must name the columns frame,point,x,y"},
    {"frame,point,x,y\n\n", "f:3:1: the file ends here: rows are needed"},
    {"frame,point,x\n", "f:1:1: the column y or y_px is missing: the header must name"},
    {"frame,frame,point,x,y\n", "f:1:7: frame: another column has the same meaning"},
    {"frame,point,x,y,x_px\n", "f:1:17: x_px: another column has the same meaning"},
    {"frame,point,x_px,y\n", "f:1:18: y: one of x and y is in pixels, the other is not"},
    {"y_px,frame,point,x\n", "f:1:1: y_px: one of x and y is in pixels"},
    {"frame,point,x,y\n0,1,2\n", "f:2:6: 3 fields, but the header has 4"},
    {"frame,point,x,y\n0,1,2,3,4\n", "f:2:9: 5 fields, but the header has 4"},
    {"frame,point,x,y\n0.5,1,2,3\n", "f:2:1: 0.5: a frame must be a whole number"},
    {"frame,point,x,y\n0,1,2,3\n0,2147483648,2,3\n", "f:3:3: 2147483648: a point must be a whole"},
    {"frame,point,x,y\n0,1, 2x,3\n", "f:2:6: 2x: a position is a finite number"},
    {"frame,point,x,y\n0,1,2,nan\n", "f:2:7: nan: a position is a finite number"},
    {"frame,point,x,y\n0,1,,3\n", "f:2:5: a position is a finite number"},
    {"frame,point,x,y\n0,1,0x10,3\n", "f:2:5: 0x10: a position is a finite number"},
    {"frame,point,x,y\n0,1,inf,3\n", "f:2:5: inf: a position is a finite number"},
    {"frame,point,x,y,visible\n0,1,2,3,2\n", "f:2:9: 2: visible must be 0 or 1"},
    {"frame,point,x,y,occluded\n0,1,2,3,\n", "f:2:9: occluded must be 0 or 1, true or false"},
    {"frame,point,x,y\n0,NA,2,3\n", "f:2:3: NA: a point must be a whole"},
    {"frame,point,x,y\n12.5,1,2,3\n", "f:2:1: 12.5: a frame must be a whole number"},
    {"frame,point,x,y\n0,1e18,2,3\n", "f:2:3: 1e18: a point must be a whole"},
    {"frame,point,x,y\n0,\"1,2,3\n", "f:2:3: a quote that is not closed in this line"},
    {"frame,point,x,y\n0,\"1\"2,2,3\n", "f:2:3: text after a closing quote"},
    {"frame,track,track_id,x,y\n", "f:1:13: track_id: another column has the same meaning"},
    {"frame,point,x,y_pos\n", "f:1:15: y_pos: this name does not match that of the x column"},
    {"0,1,2,3\n", "f:1:1: numbers, but no header"},
    {"scorer,DLC,DLC,DLC\nbodyparts,a,a,a\n", "f:1:1: DeepLabCut, three header rows: a table"},
    {"frame,x1,y1,x2,y2\n", "f:1:1: a table with several points per row"},
    {"track,frame_idx,nose.x,nose.y,tail.x,tail.y\n", "f:1:1: a table with several points"},
    {"frame;point;x;y\n0;1;2,5;3.5\n", "f:2:9: 3.5: a decimal point, but other numbers"},
    {"frame;point;x;y\n0;1;0;0\n1;1;1,234;12,345\n", "f:3:5: 1,234: is this a decimal comma"},
    {"frame;point;x;y\n0;1;1,234,5;3\n", "f:2:5: 1,234,5: a position is a finite"},
    {"frame\tpoint\tx\ty\n0\t1\t2,5\t3\n", "f:2:5: 2,5: a position is a finite"},
    {"frame,point,x,y\n0,1,2,3\n1,1,2,3\n0,1,5,6\n",
     "f:4:1: point 1 of frame 0 is already in line 2"},
};

static void test_what_is_wrong(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct grrl_tracks tracks;
        struct grrl_tracks_error error = {""};
        assert_false(read_text(wrong[i].text, &tracks, &error));
        if (strncmp(error.text, wrong[i].expected, strlen(wrong[i].expected)) != 0)
            fail_msg("expected %s\nfound    %s", wrong[i].expected, error.text);
        assert_null(tracks.id);
    }
    struct grrl_tracks tracks;
    struct grrl_tracks_error error;
    FILE *file = file_of("frame,point,x,y\n0,1\0,2,3\n", 25);
    assert_false(grrl_tracks_read_csv(file, "f", &tracks, &error));
    assert_non_null(strstr(error.text, "f:2:1: this is not text"));
    assert_int_equal(fclose(file), 0);
    file = file_of("\xff\xfe"
                   "f\0r\0",
                   6);
    assert_false(grrl_tracks_read_csv(file, "f", &tracks, &error));
    assert_non_null(strstr(error.text, "f:1:1: this is UTF-16"));
    assert_int_equal(fclose(file), 0);
}

/* The same recording, as different programs write it: always what the first one says. */
static void test_exporters(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "frame,point,x,y,visible\n0,1,2.5,-1,1\n0,2,3,4,1\n1,1,0,0,0\n1,2,3.5,4,1\n",
        "frame,point,x,y\n0.0,1,2.5,-1.0\n0.0,2,3.0,4.0\n1.0,1,,\n1.0,2,3.5,4.0\n", /* pandas */
        "frame,point,x,y\n0,1,2.5,-1\n0,2,3,4\n1,1,NaN,nan\n1,2.0,3.5,4\n",         /* numpy */
        "\"\",\"frame\",\"point\",\"x\",\"y\"\n\"1\",0,1,2.5,-1\n\"2\",0,2,3,4\n"   /* R */
        "\"3\",1,1,NA,NA\n\"4\",1,2,3.5,4\n",
        "\"frame\",\"point\",\"x\",\"y\"\n\"0\",\"1\",\"2.5\",\"-1\"\n\"0\",\"2\",\"3\",\"4\"\n"
        "\"1\",\"2\",\"3.5\" ,\"4\"\n",
        "Frame;Track ID;X;Y\r\n0;1;2,5;-1\r\n0;2;3;4\r\n1;2;3,5;4\r\n", /* a sheet */
        "\xef\xbb\xbfTRACK_ID\tID\tPOSITION_X\tPOSITION_Y\tFRAME\r1\t7\t2.5\t-1\t0\r"
        "2\t8\t3\t4\t0\r\r2\t9\t3.5\t4\t1\r",
        ",y,x,mass,frame,particle\n0,-1,2.5,9,0,1\n1,4,3,9,0,2\n2,4,3.5,9,1,2\n", /* trackpy */
        "t,id,pos_x,pos_y,occluded\n0,1,2.5,-1,False\n0,2,3,4,FALSE\n1,1,9,9,True\n1,2,3.5,4,"
        "false\n",
        "frame,point,x,y,is_visible\n0,1,2.5,-1,TRUE\n0,2,3,4,1.0\n1,1,9,9,false\n1,2,3.5,4,1\n",
        "time_index, label, x_pos, y_pos\n0e0, 1, 2.5, -1\n0, 2, 3, 4\n1, 2, 3.5, 4",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct grrl_tracks tracks;
        struct grrl_tracks_error error = {""};
        if (!read_text(texts[i], &tracks, &error))
            fail_msg("%zu: %s", i, error.text);
        assert_int_equal(tracks.n_frames, 2);
        assert_int_equal(tracks.n_points, 3);
        assert_int_equal(tracks.frame[0].n, 2);
        assert_int_equal(tracks.frame[0].number, 0);
        assert_int_equal(tracks.frame[1].number, 1);
        static const int32_t id[] = {1, 2, 2};
        static const float x[] = {2.5f, 3.0f, 3.5f};
        static const float y[] = {-1.0f, 4.0f, 4.0f};
        assert_memory_equal(tracks.id, id, sizeof id);
        assert_memory_equal(tracks.x, x, sizeof x);
        assert_memory_equal(tracks.y, y, sizeof y);
        assert_int_equal(tracks.lost.empty, i >= 1 && i <= 3);
        grrl_tracks_free(&tracks);
    }
}

static void test_quotes(void **state)
{
    (void)state;
    struct grrl_tracks tracks;
    struct grrl_tracks_error error = {""};
    assert_true(read_text("name,frame,point,x,y\n\"a \"\"b\"\", c\",0,1,2,3\nd\"e,0,2,4,5\n",
                          &tracks, &error));
    assert_int_equal(tracks.n_points, 2);
    grrl_tracks_free(&tracks);
}

static void test_decimal_commas(void **state)
{
    (void)state;
    struct grrl_tracks tracks;
    struct grrl_tracks_error error = {""};
    assert_true(
        read_text("frame;point;x;y\n0;1;0,123;1,234\n1,0;1;-12,5;1234,567\n", &tracks, &error));
    assert_true(tracks.x[0] == 0.123f && tracks.y[0] == 1.234f);
    assert_true(tracks.x[1] == -12.5f && tracks.y[1] == 1234.567f);
    grrl_tracks_free(&tracks);
}

/* Cut at every byte: an answer or a message, never anything else. */
static void test_every_cut(void **state)
{
    (void)state;
    static const char text[] = "frame,point,x,y,visible\n0,1,2.5,-3e-1,1\n1,1,2,3,0\n1,2,4,5,1\n";
    for (size_t n = 0; n < sizeof text; n++) {
        struct grrl_tracks tracks;
        struct grrl_tracks_error error = {""};
        FILE *file = file_of(text, n);
        if (grrl_tracks_read_csv(file, "f", &tracks, &error))
            grrl_tracks_free(&tracks);
        else
            assert_memory_equal(error.text, "f:", 2);
        assert_int_equal(fclose(file), 0);
    }
}

static bool read_handle(const char *text, struct grrl_handle *handle,
                        struct grrl_tracks_error *error)
{
    FILE *file = file_of(text, strlen(text));
    bool good = grrl_handle_read(file, "f", 0.001f, handle, error);
    assert_int_equal(fclose(file), 0);
    return good;
}

static void test_handle(void **state)
{
    (void)state;
    struct grrl_handle handle;
    struct grrl_tracks_error error;
    assert_true(read_handle("# x y\n 1000 2000\n3 4\t\r\n5,6\n\n7 8\n9 1e3", &handle, &error));
    assert_int_equal(handle.trajectory.n, 5);
    assert_int_equal(handle.trajectory.dimensions, 2);
    assert_true(handle.rows_m[0] == 1.0f && handle.rows_m[9] == 1.0f);
    grrl_handle_free(&handle);
    static const struct {
        const char *text;
        const char *expected;
    } cases[] = {
        {"", "f:1:1: the file ends here; at least five rows"},
        {"1 2 3\n1 2 3\n1 2 3\n1 2 3\n", "f:5:1: the file ends here; at least five rows"},
        {"1 2\n1 2 3\n", "f:2:1: 3 numbers, but the rows before have 2"},
        {"1\n", "f:1:1: 1 number only; a row is x y, x y z or a pose"},
        {"1 2 3 4\n", "f:1:1: 4 numbers; a row is x y, x y z or a pose"},
        {"1 2\n1 b\n", "f:2:3: not a finite number"},
        {"1 2m\n", "f:1:3: not a finite number"},
        {"1 inf\n", "f:1:3: not a finite number"},
        {"1 2 3 0 0 0 1\n1 2 3\n", "f:2:1: 3 numbers, but the rows before have 7"},
        {"1 2 3 4 5 6 7\n", "f:1:1: seven numbers, but the last four are not a quaternion"},
        {"1 2 3 4 0 0 0 1\n", "f:1:1: 8 numbers; a row is x y, x y z or a pose: x y z and a "
                              "quaternion (remove a leading time stamp)"},
        {"1 2 3 4 5 6 7 8 9\n", "f:1:17: a ninth number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_false(read_handle(cases[i].text, &handle, &error));
        if (strncmp(error.text, cases[i].expected, strlen(cases[i].expected)) != 0)
            fail_msg("expected %s\nfound    %s", cases[i].expected, error.text);
    }
}

static void test_pose(void **state)
{
    (void)state;
    struct grrl_handle handle;
    struct grrl_tracks_error error;
    assert_true(read_handle("1 2 3 0 0 0 1\n4 5 6 1 0 0 0\n7 8 9 .6 0 0 .8\n1 1 1 0 0 0 1\n"
                            "2 2 2 0 0 0 1\n",
                            &handle, &error));
    assert_int_equal(handle.trajectory.n, 5);
    assert_int_equal(handle.trajectory.dimensions, 3);
    for (int i = 0; i < 9; i++)
        assert_true(handle.rows_m[i] == (float)(i + 1) * 0.001f);
    grrl_handle_free(&handle);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_order),     cmocka_unit_test(test_pixels_and_no_end_of_line),
        cmocka_unit_test(test_what_is_wrong), cmocka_unit_test(test_every_cut),
        cmocka_unit_test(test_handle),        cmocka_unit_test(test_exporters),
        cmocka_unit_test(test_quotes),        cmocka_unit_test(test_decimal_commas),
        cmocka_unit_test(test_pose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
