/* Every status has a text of its own. */
#include "grrl/base/status.h"
#include "support.h"

/* Every status has a text of its own, in the form the header promises. */
static void test_texts(void **state)
{
    (void)state;
    const char *unknown = grrl_status_text((enum grrl_status)1);
    assert_non_null(unknown);
    for (int a = GRRL_ERR_POLICY; a <= GRRL_OK; a++) {
        const char *text = grrl_status_text((enum grrl_status)a);
        assert_true(strlen(text) > 0 && text[strlen(text) - 1] != '.');
        assert_string_not_equal(text, unknown);
        for (int b = GRRL_ERR_POLICY; b < a; b++)
            assert_string_not_equal(text, grrl_status_text((enum grrl_status)b));
    }
    assert_string_equal(grrl_status_text((enum grrl_status)(GRRL_ERR_POLICY - 1)), unknown);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
