#!/bin/bash
# The types of the messages as they are installed, for Python and, where a JDK is, for Java: every
# message of a run is decoded, and encoded to the same bytes. Java reads the log with LCM's own class.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7741?ttl=0'
BUILD=$(dirname "$(dirname "$SIM")")
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
cmake --install "$BUILD" --prefix "$WORK/prefix" >install.txt 2>&1 || fail "cmake --install"
start agent timeout 60 "$AGENT" --lcm-url "$URL"
agent=$LAST
timeout 60 "$SIM" --lcm-url "$URL" --object RR --trials 1 --log run.lcm >sim.txt 2>&1 ||
    fail "grrl-sim ended with $?"
finish "$agent" grrl-agent

cat >decode.py <<'END_OF_PYTHON'
import struct
import grrl_lcmtypes
seen = {}
with open("run.lcm", "rb") as log:
    while head := log.read(28):
        sync, _, _, n_channel, n_data = struct.unpack(">IqqII", head)
        assert sync == 0xEDA1DA01
        channel, data = log.read(n_channel).decode(), log.read(n_data)
        kind = getattr(grrl_lcmtypes, channel[len("GRRL_"):].lower() + "_t")
        assert kind.decode(data).encode() == data, channel
        seen[channel] = seen.get(channel, 0) + 1
for name in ("agent_status", "decision", "image", "model", "points", "push_command", "push_status", "stop",
             "trial"):
    message = getattr(grrl_lcmtypes, name + "_t")()
    if name == "image":
        message.data = b"\x00\xff"
        message.n_bytes = len(message.data)
    assert message.decode(message.encode()).encode() == message.encode(), name
print(*(f"{channel} {n}" for channel, n in sorted(seen.items())), sep="\n")
END_OF_PYTHON
PYTHONPATH=prefix/share/grrl/python PYTHONDONTWRITEBYTECODE=1 python3 decode.py >python.txt 2>&1 ||
    fail "grrl_lcmtypes"
for channel in DECISION MODEL POINTS PUSH_COMMAND PUSH_STATUS TRIAL; do
    grep -q "^GRRL_$channel [1-9]" python.txt || fail "no GRRL_$channel in the log"
done

lcm_jar=$(sed -n 's/^LCM_JAR:FILEPATH=//p' "$BUILD/CMakeCache.txt")
if [ ! -f "$BUILD/lcmtypes/grrl_types.jar" ]; then
    echo "no grrl_types.jar here: tools/setup spy"
    exit 0
fi
cat >Types.java <<'END_OF_JAVA'
import java.io.EOFException;
import java.util.Arrays;
import java.util.Map;
import java.util.TreeMap;
import lcm.lcm.LCMDataOutputStream;
import lcm.lcm.LCMEncodable;
import lcm.logging.Log;

class Types {
    public static void main(String[] arguments) throws Exception {
        Map<String, Integer> seen = new TreeMap<>();
        Log log = new Log("run.lcm", "r");
        try {
            while (true) {
                Log.Event event = log.readNext();
                String name = "grrl." + event.channel.substring("GRRL_".length()).toLowerCase() + "_t";
                LCMEncodable message = (LCMEncodable) Class.forName(name).getConstructor(byte[].class)
                    .newInstance((Object) event.data);
                LCMDataOutputStream out = new LCMDataOutputStream();
                message.encode(out);
                if (!Arrays.equals(out.toByteArray(), event.data))
                    throw new Exception(event.channel + ": other bytes");
                seen.merge(event.channel, 1, Integer::sum);
            }
        } catch (EOFException end) {
            seen.forEach((channel, n) -> System.out.println(channel + " " + n));
        }
    }
}
END_OF_JAVA
java -cp "$lcm_jar:prefix/share/java/grrl_types.jar" Types.java >java.txt 2>java.err.txt ||
    fail "grrl_types.jar"
same python.txt java.txt
