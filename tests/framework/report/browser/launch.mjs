// Starts a headless Chromium of its own: own profile, no network, no sandbox, no shared memory of /dev/shm.
import {createRequire} from 'node:module';
import {join} from 'node:path';

const {chromium} = createRequire(join(process.env.TWINMAP_PLAYWRIGHT, 'index.js'))('playwright-core');
const kFlags = ['--disable-gpu', '--no-first-run', '--disable-background-networking', '--disable-component-update'];
const kTries = 3;

/** Longer than anything takes on the most loaded machine, a start among them: one that hangs is tried again. */
export const kPatience = 240_000, kStart = 120_000; // ms

/** A browser; a start that fails, as it may where memory is short for a moment, is tried again. */
export async function launchBrowser(tries = kTries, flags = kFlags) {
  try {
    return await chromium.launch({
      executablePath: process.env.TWINMAP_CHROMIUM ?? '/usr/bin/chromium', args: flags, chromiumSandbox: false,
      timeout: kStart, handleSIGINT: true
    });
  } catch (error) {
    if (tries <= 1) throw error;
    console.error(`Chromium did not start, trying again: ${error.message}`);
    return launchBrowser(tries - 1, flags);
  }
}

/** A page that waits as long as it takes. */
export async function openPage(browser, options = {}) {
  const context = await browser.newContext({
    viewport: {width: 1280, height: 900}, reducedMotion: 'reduce', ...options
  });
  context.setDefaultTimeout(kPatience);
  return context.newPage();
}
