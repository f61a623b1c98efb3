#!/usr/bin/env python3
"""Instructions of a kernel by pipe, between addresses: what bench/floor/instructions.h is filled from.

  cuobjdump -sass cuda_trace.cu.o | scripts/count_sass.py KERNEL START-END[,START-END]...
  cuobjdump -sass cuda_trace.cu.o | scripts/count_sass.py KERNEL

KERNEL: a regular expression that finds one function. Without addresses, branches and loads are listed with theirs, to
find the parts by. Both ends are counted.
"""
import re
import sys

# Hopper's pipes after Nsight Compute's list of them; what is in none of these only takes its issue slot. FP32 adds,
# multiplications and IMAD are not counted apart: there is twice the room for them.
PIPES = {
    "alu": r"FSEL|FMNMX|FSETP|ISETP|LOP3|PLOP3|SHF|LEA|IADD|IADD3|VIADD|SEL|PRMT|MOV|IMNMX|VIMNMX|CS2R",
    "fp64": r"D[A-Z]+",
    "convert": r"F2F|F2I|I2F|MUFU|FRND",
}


def instructions(kernel):
    inside = False
    for line in sys.stdin:
        if "Function :" in line:
            inside = re.search(kernel, line) is not None
        match = re.match(r"\s+/\*([0-9a-f]{4,5})\*/\s+(.*?);", line)
        if inside and match:
            yield int(match[1], 16), match[2]


def pipe_of(text):
    name = re.sub(r"^@!?U?P\d+\s+", "", text).split()[0].split(".")[0]
    return next((pipe for pipe, names in PIPES.items() if re.fullmatch(names, name)), None)


def main():
    code = list(instructions(sys.argv[1]))
    if len(sys.argv) < 3:
        for address, text in code:
            if re.search(r"\b(BRA|BSSY|BSYNC|EXIT|CALL|LDG|STG|LDL|STL)\b", text):
                print(f"{address:04x}  {text}")
        return
    for part in sys.argv[2:]:
        spans = [[int(end, 16) for end in span.split("-")] for span in part.split(",")]
        chosen = [text for address, text in code if any(lo <= address <= hi for lo, hi in spans)]
        pipes = [pipe_of(text) for text in chosen]
        print(part, {"issued": len(chosen), **{pipe: pipes.count(pipe) for pipe in PIPES}})


main()
