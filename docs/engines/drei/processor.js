// Processor time of Chromium's GPU process, which a software rasterizer runs in.

import { readdirSync, readFileSync } from 'node:fs';

/** Milliseconds of a tick of /proc: Linux has 100 a second. */
const TICK = 10;

/** Milliseconds so far of the GPU process of the Chromium with a profile; NaN where unknown. */
export function processorTime(profile) {
  for (const process of profile ? readdirSync('/proc').filter((name) => /^\d+$/.test(name)) : []) {
    try {
      const command = readFileSync(`/proc/${process}/cmdline`, 'utf8');
      if (!command.includes('--type=gpu-process') || !command.includes(profile)) continue;
      // After the name, which is in parentheses: user and system time are fields 14 and 15.
      const fields = readFileSync(`/proc/${process}/stat`, 'utf8').replace(/^.*\) /s, '').split(' ');
      return TICK * (Number(fields[11]) + Number(fields[12]));
    } catch {
      // The process has ended meanwhile.
    }
  }
  return NaN;
}
