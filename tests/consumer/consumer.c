/*
 * Uses the installed library, and proves that it and this file agree about the size of a struct:
 * the library fills a graph to its own capacity, which must be the one seen here.
 */
#include <stdio.h>
#include <string.h>

#include <grrl/grrl.h>

static int capacities_agree(void)
{
    static struct grrl_graph graph;
    unsigned n = 0;
    uint8_t link;
    grrl_graph_clear(&graph);
    while (n <= 64 && grrl_graph_add_link(&graph, 0, &link) == GRRL_OK)
        n++;
    if (n == GRRL_MAX_LINKS)
        return 1;
    (void)fprintf(stderr, "the library holds %u links, its headers say %d\n", n, GRRL_MAX_LINKS);
    return 0;
}

static int reads_a_term(void)
{
    static struct grrl_term_node nodes[32];
    static struct grrl_term_store store;
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_term_error error;
    const char *text = "D(lb, R(l1, P(l2, l3)))";
    grrl_term term;
    grrl_term_store_init(&store, nodes, 32);
    if (grrl_term_parse(&store, text, strlen(text), &term, &error) != GRRL_OK ||
        grrl_graph_from_term(&store, term, &graph, names, NULL, NULL, &error) != GRRL_OK) {
        (void)fprintf(stderr, "%s\n", error.message);
        return 0;
    }
    return grrl_graph_joint_count(&graph) == 2;
}

int main(void)
{
    if (!capacities_agree() || !reads_a_term())
        return 1;
    (void)printf("%d links\n", GRRL_MAX_LINKS);
    return 0;
}
