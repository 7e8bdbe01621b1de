#include "bench.h"
int bench_retrieve(bool json)
{
    return (int)json;
}
