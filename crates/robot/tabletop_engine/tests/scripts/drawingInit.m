% Figures: with a display they appear, without one they do no harm.
figure(1); clf;
subplot(1, 2, 1); hold on; grid on
plot(0:0.1:1, (0:0.1:1) .^ 2, 'r-');
axis([0 1 0 1]); text(0.5, 0.5, 'here'); title('a curve');
calls = 0;
