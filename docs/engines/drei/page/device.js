// The WebGPU device that Lapidary's frames run on.

/** Returns a device, and its adapter's name. */
export async function openDevice() {
  const adapter = await navigator.gpu?.requestAdapter({ powerPreference: 'high-performance' });
  if (!adapter) throw new Error('this browser has no WebGPU');
  const device = await adapter.requestDevice();
  const { vendor, architecture, description } = adapter.info;
  return { device, driver: [description, architecture, vendor].filter(Boolean).join(', ') };
}
