#!/bin/bash
# examples/robot.py as docs/robot.md starts it: a model after every push, the right term, and the red
# button. Skipped without a Python with LCM.
. "$(dirname "$0")/common.sh"
ROOT=$OLDPWD
[ -f "$ROOT/examples/robot.py" ] || ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
URL='udpm://239.255.76.67:7738?ttl=0'
python=
for candidate in "$ROOT/build/robot/venv/bin/python" "$ROOT/build/mujoco/venv/bin/python" python3; do
    "$candidate" -c 'import lcm' 2>/dev/null && python=$candidate && break
done
if [ -z "$python" ]; then
    echo "skipped: no Python with lcm (python3 -m venv build/robot/venv &&" \
        "build/robot/venv/bin/pip install lcm)"
    exit 77
fi
PYTHONPATH=$(dirname "$(dirname "$SIM")")/lcmtypes/python
export PYTHONPATH PYTHONDONTWRITEBYTECODE=1 PYTHONUNBUFFERED=1
cat >listen.py <<'END'
import sys
import lcm
from grrl_lcmtypes import model_t
bus = lcm.LCM(sys.argv[1])
bus.subscribe("GRRL_MODEL", lambda _, data: print("model", model_t.decode(data).cmd_seq))
print("ready")
while True:
    bus.handle()
END
start listen "$python" listen.py "$URL"
for _ in $(seq 100); do
    grep -q ready listen.txt && break
    sleep 0.1
done
start robot "$python" "$ROOT/examples/robot.py" "$URL"
robot=$LAST
timeout 100 "$AGENT" --lcm-url "$URL" --explain --until-sure 0.95 --pushes 40 >agent.txt 2>&1 ||
    fail "the agent ended with $?"
grep -q '^sure: ' agent.txt || fail "the agent does not say that it is sure"
grep -q '^found after push .*: D(lb, R(L(s, f[0-9]*), L(s, f[0-9]*)))$' agent.txt || fail "no hinge"
grep -q '^  f[0-9]* f[0-9]* revolute [01].*, pivot (-\?0.00' agent.txt || fail "the pin is elsewhere"
grep -q 'in all' agent.txt && fail "examples/robot.py makes a mistake"
pushes=$(grep -c ' push [0-9]*: f' agent.txt)
sleep 0.2
for k in $(seq 0 "$pushes"); do
    grep -qx "model $k" listen.txt || fail "no model after push $k of $pushes"
done

start stopped timeout 60 "$AGENT" --lcm-url "$URL"
agent=$LAST
sleep 1.5
kill -INT "$robot"
wait "$agent"
[ $? = 3 ] || fail "the red button did not end the agent with 3"
grep -q 'reason OPERATOR' stopped.txt || fail "it does not say why"
